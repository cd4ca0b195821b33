#include "harness/compare/along_runs.hpp"

#include <algorithm>
#include <cmath>

#include "harness/statistics/average.hpp"
#include "harness/statistics/block_length.hpp"

namespace loopbench {
namespace {

std::vector<double> squared(std::span<const double> values) {
  std::vector<double> out;
  for (const double value : values) out.push_back(value * value);
  return out;
}

}  // namespace

std::optional<AlongRuns> ratio_along_runs(std::span<const RunErrors> runs,
                                          const BootstrapOptions& options) {
  if (runs.empty()) return std::nullopt;
  AlongRuns out;
  const auto count = static_cast<double>(runs.size());
  std::vector<double> sums(options.resamples, 0.0);  // of logarithms, over the runs
  double estimate = 0.0;
  BootstrapOptions of_run = options;
  for (const RunErrors& run : runs) {
    const std::size_t n = run.method.size();
    const std::vector<double> method = squared(run.method);
    const std::vector<double> baseline = squared(run.baseline);
    if (n < kFewestPoses || n != baseline.size()) return std::nullopt;
    if (!(mean(method) > 0.0 && mean(baseline) > 0.0)) return std::nullopt;
    std::vector<double> difference;
    for (std::size_t i = 0; i < n; ++i) difference.push_back(method[i] - baseline[i]);
    const std::size_t block = block_length(difference);
    out.longest = std::max(out.longest, block);
    const Resampled ratio = [&](std::span<const std::size_t> indices) {
      double above = 0.0;
      double below = 0.0;
      for (const std::size_t i : indices) {
        above += method[i];
        below += baseline[i];
      }
      return above > 0.0 && below > 0.0 ? 0.5 * std::log(above / below) : 0.0;
    };
    const std::vector<double> values = block_values(n, block, ratio, of_run);
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += values[i] / count;
    estimate += 0.5 * std::log(mean(method) / mean(baseline)) / count;
    ++of_run.seed;  // the runs know nothing of each other
  }
  std::ranges::sort(sums);
  const double tail = 0.5 * (1.0 - options.level);
  out.ratio = {
      std::exp(estimate), std::exp(quantile(sums, tail)), std::exp(quantile(sums, 1.0 - tail))};
  return out;
}

}  // namespace loopbench
