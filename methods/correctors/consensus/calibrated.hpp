/// Deviations that the loop closures of a problem show, in place of those stated.
#pragma once

#include <optional>
#include <string>

#include "datasets/core/problem.hpp"
#include "methods/report.hpp"

namespace loopbench::methods {

/// Both names of the option of a method that corrects calibrated(problem).
template <class Options, class Visit>
void calibration_fields(Options& o, Visit visit) {
  visit(
      "calibrate",
      o.calibrate,
      "replace the stated deviations by those that the closures show, as consensus estimates them; "
      "all closures are used");
  visit("rescale", o.rescale, "old name of calibrate");
}

template <class Options>
bool is_calibrated(const Options& o) {
  return o.calibrate || o.rescale;
}

/// Returns why calibrated() does not apply, or an empty text.
std::string why_not_calibrated(const Problem& problem);

/// Returns the problem with all closures and the information divided by the squared factors that
/// judge_closures() estimates. Adds the counts `factor_t`, `factor_r` and `factor_closures`,
/// factors on standard deviations. If the closures do not decide, the stated deviations stay, with
/// a note. Requires why_not_calibrated() to be empty. Deterministic. No reference is used.
Problem calibrated(const Problem& problem, Report& report);

/// Returns calibrated(problem) if the options ask for it, with a note if they do by the old name.
template <class Options>
std::optional<Problem> calibrated_if_asked(const Options& o,
                                           const Problem& problem,
                                           Report& report) {
  if (o.rescale) report.notes.emplace_back("rescale is the old name of calibrate");
  if (!is_calibrated(o)) return std::nullopt;
  return calibrated(problem, report);
}

}  // namespace loopbench::methods
