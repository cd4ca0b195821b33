/// Metadata of a sequence, and its identity: equal content, and shared noise.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/sequence.hpp"
#include "harness/sweep/model/cells.hpp"
#include "harness/sweep/model/sequence_metadata.hpp"
#include "harness/sweep/model/sweep.hpp"

namespace loopbench::harness {

/// Hash of the method's input and the reference: keyframes, frames, odometry, closures with
/// information and scale, shared_landmarks, planar, anchors and the reference, bit by bit.
/// Sequences with equal content are one observation. O(poses + edges).
std::string content_of(const Sequence& sequence);

/// Hash of stamps and poses, bit by bit. O(n).
std::string hash_of_poses(const Trajectory& poses);

/// Source of the noise in a sequence; sequences with equal source are not independent.
///
/// `reference:HASH`: measured data, hash of the shape of the reference: distances from its first
/// position, rounded to a millimetre. Everything derived from one recording shares its motion and
/// sensor noise: several odometers on one route, several runs of one system, closures drawn with
/// several seeds. Comments and the format of the file, stamps, `reference_body`, `truth_axes` and
/// keyframe rules do not change it.
///
/// `noise:HASH`: simulated data, by stream and seed. Another seed draws all noise anew and is
/// another source although the path is the same: paths are closed formulas selected by the config,
/// not a sample of a population of paths. A test over seeds therefore supports claims about
/// other noise on these paths, and a test over recordings claims about other recordings. For a
/// statement about paths, set `group` in the dataset's entry.
///
/// `estimate:HASH`: no reference; by the poses of the keyframes. O(poses).
std::string source_of(const Sequence& sequence);

/// Reads the inputs again to hash them. `group` is the source. Throws InputError.
SequenceMetadata sequence_metadata(const Sequence& sequence, bool with_trace);

/// The same for the sequence of a cell, with notes about its evaluation; the dataset's `group`
/// overrides the source. Throws InputError.
SequenceMetadata metadata_of(const Sequence& sequence, const Cell& cell, const Sweep& sweep);

/// The files with their sizes and hashes. The hash of an optional file that does not exist (an
/// image of a recording) is `missing`, so that a later run detects when it is added. Throws
/// InputError for a file that cannot be read.
std::vector<InputFile> hashed_inputs(const std::vector<InputPath>& files);

}  // namespace loopbench::harness
