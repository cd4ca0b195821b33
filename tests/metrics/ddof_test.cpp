/// Every metric with a distribution uses the protocol's ddof for its standard deviation.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "evaluated_cell.hpp"
#include "metrics/metric.hpp"
#include "support.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::test::ddof_test {
namespace {

/// A pose every 20 ms, so that some lie between keyframes.
Trajectory finely(const Trajectory& truth) {
  std::vector<double> times;
  for (double time = truth.front().stamp; time <= truth.back().stamp; time += 0.02) {
    times.push_back(time);
  }
  return Polyline(truth).sample(times);
}

Trajectory half_corrected(Trajectory keyframes) {
  const Trajectory truth = test::hand_held_truth();
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    Pose& pose = keyframes[i].world_from_body;
    pose = interpolate(pose, truth[i].world_from_body, 0.5);
  }
  return keyframes;
}

std::vector<Score> scores(const MetricEntry& entry, int ddof) {
  const Problem problem = test::hand_held();
  const test::EvaluatedCell cell(finely(test::hand_held_truth()),
                                 problem,
                                 half_corrected(problem.keyframes),
                                 {.tolerance = 0.9, .ddof = ddof});
  return entry.score(cell.evaluation, {});
}

TEST(Ddof, OfTheProtocolReachesEveryDistribution) {
  std::set<std::string> evaluated;
  for (const MetricEntry& entry : metrics::metrics()) {
    std::vector<Score> plain, unbiased;
    try {
      plain = scores(entry, 0);
      unbiased = scores(entry, 1);
    } catch (const Undefined&) {
      continue;
    }
    ASSERT_EQ(plain.size(), unbiased.size()) << entry.name;
    for (std::size_t i = 0; i < plain.size(); ++i) {
      const Statistics& s = plain[i].statistics;
      if (s.count < 2 || s.std == 0.0) continue;
      const auto n = static_cast<double>(s.count);
      EXPECT_NEAR(unbiased[i].statistics.std, s.std * std::sqrt(n / (n - 1.0)), 1e-12 * s.std)
          << entry.name << " " << plain[i].relation;
      evaluated.insert(entry.name);
    }
  }
  for (const char* name :
       {"ate", "rpe", "along_cross", "closure_residual", "interpolation_floor", "jerk", "jumps"}) {
    EXPECT_TRUE(evaluated.contains(name)) << name;
  }
}

}  // namespace
}  // namespace loopbench::test::ddof_test
