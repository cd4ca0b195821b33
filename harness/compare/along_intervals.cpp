#include "harness/compare/along_intervals.hpp"

#include <algorithm>

#include "harness/compare/along_runs.hpp"

namespace loopbench {
namespace {

/// Errors at the stamps that both have.
RunErrors shared(const StampedErrors& method, const StampedErrors& baseline) {
  RunErrors out;
  for (std::size_t m = 0, b = 0; m < method.stamps.size() && b < baseline.stamps.size();) {
    if (method.stamps[m] < baseline.stamps[b]) {
      ++m;
    } else if (method.stamps[m] > baseline.stamps[b]) {
      ++b;
    } else {
      out.method.push_back(method.errors[m++]);
      out.baseline.push_back(baseline.errors[b++]);
    }
  }
  return out;
}

bool is_of_positions(const Comparison& c) {
  return c.kind.metric == "ate" && c.kind.relation == "translation" && c.kind.axis == "3d" &&
         c.options.value == "rmse" && c.options.over == Over::runs;
}

}  // namespace

void add_intervals_along_runs(Comparison& c, const ErrorsOf& errors_of) {
  if (c.observations >= kFewestForInterval || !is_of_positions(c)) return;
  std::vector<StampedErrors> baseline;
  for (const std::string& run : c.runs) baseline.push_back(errors_of(c.options.baseline, run));
  for (MethodVerdict& method : c.methods) {
    if (!method.ratio || method.method == c.options.baseline) continue;
    std::vector<RunErrors> runs;
    for (std::size_t run = 0; run < c.runs.size(); ++run) {
      runs.push_back(shared(errors_of(method.method, c.runs[run]), baseline[run]));
    }
    // A fifth of the usual number: each goes through every pose of every run.
    const auto along =
        ratio_along_runs(runs, {c.options.resamples / 5, 1.0 - c.options.alpha, c.options.seed});
    if (!along) continue;
    // The poses kept are a part of those judged: their spread, around the number of all.
    const double all = method.ratio->estimate / along->ratio.estimate;
    method.ratio->low = all * along->ratio.low;
    method.ratio->high = all * along->ratio.high;
    method.has_interval = true;
    c.longest_block = std::max(c.longest_block, along->longest);
  }
}

}  // namespace loopbench
