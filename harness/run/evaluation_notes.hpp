/// Notes about limitations of an evaluation.
#pragma once

#include <string>
#include <vector>

#include "harness/model/sweep.hpp"
#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::harness {

/// One sentence for each limitation found; `reference` is the complete one:
/// - stamp differences within pairs alone explain a fifth of the ATE or more;
/// - the alignment has more than a tenth as many parameters as the pairs have coordinates, so the
///   fit itself reduces the errors;
/// - a dense curve bridges tracking gaps.
std::vector<std::string> evaluation_notes(const Trajectory& reference,
                                          const metrics::Evaluation& evaluation);

/// The same for the keyframes of a sequence under every protocol and choice of times of the sweep,
/// and for a coverage below one half. Without duplicates.
std::vector<std::string> evaluation_notes(const Sequence& sequence, const Sweep& sweep);

}  // namespace loopbench::harness
