/// Deviations that the loop closures of a problem show, in place of those stated.
#pragma once

#include <string>

#include "datasets/core/problem.hpp"
#include "methods/report.hpp"

namespace loopbench::methods {

/// Returns why calibrated() does not apply, or an empty text.
std::string why_not_calibrated(const Problem& problem);

/// Returns the problem with all closures and the information divided by the squared factors that
/// judge_closures() estimates. Adds the counts `factor_t`, `factor_r` and `factor_closures`,
/// factors on standard deviations. If the closures do not decide, the stated deviations stay, with
/// a note. Requires why_not_calibrated() to be empty. Deterministic. No reference is used.
Problem calibrated(const Problem& problem, Report& report);

/// Adds a note if the option is given by its old name.
void note_old_name(bool is_rescale, Report& report);

}  // namespace loopbench::methods
