/// Which sequences hold the same numbers, and which share the noise in them.
#pragma once

#include <string>

#include "datasets/core/sequence.hpp"

namespace loopbench {

/// Hash of all that a method is given and is judged against: keyframes, frames, odometry, closures
/// with information and scale, common_view, planar and the reference, bit by bit. Equal content is
/// one observation, however often it was loaded. O(poses + edges).
std::string content_of(const Sequence& sequence);

/// The noise that a sequence shares with others; sequences of equal source are not independent.
///
/// `reference:HASH`: measured data, by the bytes of the reference file. Whatever was derived from
/// one recording shares its motion and its sensor noise: several odometers on one route, several
/// runs of one system, closures drawn with several seeds. `reference_body` and keyframe rules make
/// no difference. Where the reference is no file of its own, its poses are hashed.
///
/// `noise:HASH`: simulated data, by stream and seed. Another seed draws all noise anew and is
/// another source although the path is the same: paths are closed formulas that a config selects,
/// no sample of a population of paths. A p value over seeds therefore says what other noise on
/// these paths would do, one over recordings what other recordings would do; `group` in a dataset's
/// entry groups by path where a statement about paths is wanted.
///
/// `estimate:HASH`: no reference; by the poses of the keyframes.
///
/// `reference_hash`: of the file in Provenance::reference; empty where there is none.
std::string source_of(const Sequence& sequence, const std::string& reference_hash);

}  // namespace loopbench
