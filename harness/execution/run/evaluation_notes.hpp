/// What a reader has to know before quoting the numbers of an evaluation.
#pragma once

#include <string>
#include <vector>

#include "harness/model/sweep.hpp"
#include "metrics/evaluation/evaluation.hpp"

namespace loopbench {

/// One sentence for each that applies; `reference` is the whole one:
/// - the stamps of the pairs differ, and that alone explains a fifth of the ATE or more;
/// - the alignment has more than a tenth as many parameters as the pairs have coordinates, so that
///   the fit itself makes the errors smaller;
/// - a dense curve bridges tracking gaps.
std::vector<std::string> evaluation_notes(const Trajectory& reference,
                                          const Evaluation& evaluation);

/// The same for the keyframes of a sequence under every protocol and choice of times of the sweep,
/// and a coverage below a half. Each is said once.
std::vector<std::string> evaluation_notes(const Sequence& sequence, const Sweep& sweep);

}  // namespace loopbench
