/// pose_graph with a kept order: its minimum, reached in parts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "methods/correctors/pose_graph.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::incremental_smoother_test {

using namespace methods;

namespace {

/// Keyframes `begin` to `end` - 1, their odometry, and the closures that end there.
Increment part(const Problem& problem, std::size_t begin, std::size_t end) {
  Increment out;
  for (std::size_t i = begin; i < end; ++i) {
    out.keyframes.push_back(problem.keyframes[i]);
    if (i > 0) out.odometry.push_back(problem.odometry[i - 1]);
  }
  for (const Edge& closure : problem.closures) {
    if (closure.to >= begin && closure.to < end) out.closures.push_back(closure);
  }
  return out;
}

/// Of the problem, in parts of 20 keyframes.
Trajectory in_parts(const Problem& problem, const Corrector& method, Report& report) {
  const auto incremental = method.incremental(problem.planar);
  Trajectory out;
  for (std::size_t begin = 0; begin < problem.keyframes.size(); begin += 20) {
    out = incremental->update(part(problem, begin, begin + 20), report);
    EXPECT_EQ(out.size(), begin + 20);
  }
  return out;
}

TEST(PoseGraph, KeepsItsOrderInPartsAndReachesTheSameMinimum) {
  const Problem problem = test::walk(2, 80, 0.02);
  Report report;
  const PoseGraphOptimizer method({.keep_order = 3.0});
  const Trajectory expected = test::corrected<PoseGraphOptimizer>(problem);
  test::expect_close(in_parts(problem, method, report), expected, 1e-6);
  // The first update has no closure yet: it is declined.
  ASSERT_GE(report.counts.size(), 2u);
  EXPECT_EQ(report.counts[report.counts.size() - 2].name, "orders");
  EXPECT_EQ(report.counts[report.counts.size() - 2].value, 1.0);
  EXPECT_EQ(report.counts.back().name, "updates_declined");
}

TEST(PoseGraph, RescalesInPartsAsAtOnce) {
  const Problem problem = test::walk(2, 80, 0.02);
  const auto options = [](std::optional<double> keep_order) {
    return PoseGraphOptimizer::Options{.rescale = true, .keep_order = keep_order};
  };
  const PoseGraphOptimizer method(options(2.0));
  Report report;
  test::expect_close(in_parts(problem, method, report),
                     PoseGraphOptimizer(options({})).correct(problem, report),
                     1e-6);
}

TEST(PoseGraph, KeepsAnOrderOnlyWithoutALoss) {
  EXPECT_EQ(PoseGraphOptimizer({}).incremental(false), nullptr);
  const PoseGraphOptimizer robust({.loss = RobustLoss::huber, .keep_order = 2.0});
  EXPECT_THAT(robust.why_declined(test::walk(2, 80, 0.02)), ::testing::HasSubstr("loss: none"));
}

}  // namespace
}  // namespace loopbench::incremental_smoother_test
