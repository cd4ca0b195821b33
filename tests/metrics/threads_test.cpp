/// Evaluations that run at the same time, as those of `eval` and of a sweep's metrics do.
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/core/parallel.hpp"
#include "datasets/core/so3.hpp"
#include "metrics/metric.hpp"
#include "metrics/protocols/protocols.hpp"

namespace loopbench::threads_test {

using namespace metrics;

namespace {

/// A path of two ranges of parallel_for_blocks(), drifting by `drift` per pose.
Trajectory path(double drift) {
  Trajectory out(2 * kMinItemsPerThread);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double t = 0.01 * static_cast<double>(i);
    out[i] = {t,
              {exp_so3(Vector3(0.1 * std::sin(t), 0.0, 0.05 * t)),
               Vector3(std::cos(0.1 * t), std::sin(0.1 * t) + drift * t, 0.01 * t)}};
  }
  return out;
}

/// The root mean squares of all scores that are defined.
std::vector<double> errors(const Trajectory& reference,
                           const Trajectory& estimate,
                           const std::string& protocol) {
  const Evaluation evaluation = evaluate(reference, estimate, named_protocol(protocol).rules);
  std::vector<double> out;
  for (const MetricEntry& entry : metrics::metrics()) {
    if (entry.name != "ate" && entry.name != "rpe" && entry.name != "axis_error") continue;
    for (const Score& score : entry.score(evaluation, {})) out.push_back(score.statistics.rmse);
  }
  return out;
}

TEST(Evaluations, ThreadsDoNotMatter) {
  const Trajectory reference = path(0.0);
  const Trajectory estimate = path(1e-4);
  std::vector<std::vector<double>> together(2);
  parallel_for_tasks(together.size(), [&](std::size_t i) {
    together[i] = errors(reference, estimate, "loopbench");
  });
  EXPECT_GE(together[0].size(), 8u);
  EXPECT_EQ(together[0], together[1]);
}

}  // namespace
}  // namespace loopbench::threads_test
