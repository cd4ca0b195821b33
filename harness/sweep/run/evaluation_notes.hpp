/// Notes about limitations of an evaluation, and findings of `doctor` about its input.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/sequence.hpp"
#include "harness/sweep/model/note.hpp"
#include "harness/sweep/model/sweep.hpp"
#include "methods/correctors/consensus/judgement.hpp"
#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::harness {

/// One note for each limitation found; `reference` is the complete one:
/// - stamp differences within pairs alone explain a fifth of the ATE or more;
/// - the alignment has more than a tenth as many parameters as the pairs have coordinates, so the
///   fit itself reduces the errors;
/// - a dense curve bridges tracking gaps.
std::vector<Note> evaluation_notes(const Trajectory& reference,
                                   const metrics::Evaluation& evaluation);

/// The same for the keyframes of a sequence under every protocol and choice of times of the sweep,
/// and for a coverage below one half. Without duplicates.
std::vector<Note> evaluation_notes(const Sequence& sequence, const Sweep& sweep);

/// Two trajectories as they were read.
struct ReadPair {
  const Trajectory& reference;
  const Trajectory& estimate;
  std::string reference_name;
  std::string estimate_name;
  bool has_stamps = true;  ///< false if the stamps of either are generated
};

/// A note for each finding with a confidence of at least 0.5 that the protocols leave: the
/// estimate is shifted by the offset of the first one, and its scale is checked only if some
/// protocol does not align it. Empty without protocols.
std::vector<Note> doctor_notes(const ReadPair& pair,
                               const std::vector<metrics::NamedProtocol>& protocols);

/// The same for the keyframes of measured data, with options of configs, and for its closures and
/// information. Empty for simulated data.
std::vector<Note> doctor_notes(const Sequence& sequence, const Sweep& sweep);

/// A note for each finding about closures and information with a confidence of at least 0.5.
/// `known`: judgement of the closures of this problem; null: it is computed.
std::vector<Note> closure_notes(const Problem& problem,
                                const methods::ClosureJudgement* known = nullptr);

}  // namespace loopbench::harness
