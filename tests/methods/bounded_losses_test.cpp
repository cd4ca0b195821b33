// Dynamic covariance scaling with default options.
#include <gtest/gtest.h>

#include "methods/correctors/pose_graph.hpp"
#include "methods/solvers/pose_graph_solver.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/simulated_drive.hpp"

namespace loopbench::bounded_losses_test {

using namespace methods;

namespace {

constexpr PoseGraphOptimizer::Options kDcs{.loss = RobustLoss::dcs};

Sequence driving(std::int64_t seed, double false_share) {
  return test::simulated_drive({.seed = seed, .false_share = false_share});
}

/// RMS position error [m], not aligned: the first pose is exact.
double error(const Trajectory& keyframes, const Sequence& sequence) {
  return test::rmse(keyframes, test::at_stamps_of(keyframes, sequence.reference));
}

double error(const Sequence& sequence, const PoseGraphOptimizer::Options& options) {
  return error(test::corrected<PoseGraphOptimizer>(sequence.problem, options), sequence);
}

struct Direct {
  Trajectory keyframes;
  double chi2 = 0.0;
};

/// The minimum of the loss that the keyframes lead to, without other widths before.
Direct solved_directly(const Problem& problem, double width) {
  std::vector<ScaledPose> poses;
  for (const StampedPose& each : problem.keyframes) poses.push_back({each.world_from_body});
  const std::vector<double> weights(problem.closures.size(), 1.0);
  EliminationCache cache;
  const PoseGraphSummary summary =
      solve_pose_graph(poses,
                       {problem.odometry, problem.closures, weights},
                       {.group = Group::se2, .loss = RobustLoss::dcs, .loss_width = width},
                       cache);
  Direct out{problem.keyframes, 2.0 * summary.cost};
  for (std::size_t i = 0; i < poses.size(); ++i) out.keyframes[i].world_from_body = poses[i].pose;
  return out;
}

TEST(BoundedLosses, KeepTrueClosuresOnADriveWith30PercentFalse) {
  double without = 0.0, robust = 0.0, narrow = 0.0;
  for (int seed = 1; seed <= 5; ++seed) {
    without += error(driving(seed, 0.0), {});
    const Sequence mixed = driving(seed, 0.3);
    robust += error(mixed, kDcs);
    narrow += error(solved_directly(mixed.problem, 1.0).keyframes, mixed);
  }
  EXPECT_GT(narrow, 2.0 * without);  // almost no gain over no correction
  EXPECT_LT(robust, 1.25 * without);
}

TEST(BoundedLosses, CostLittleWhenAllClosuresAreTrue) {
  double plain = 0.0, robust = 0.0;
  for (int seed = 1; seed <= 5; ++seed) {
    plain += error(driving(seed, 0.0), {});
    robust += error(driving(seed, 0.0), kDcs);
  }
  EXPECT_LT(robust, 1.1 * plain);
}

TEST(BoundedLosses, TakeTheLowerOfBothMinima) {
  constexpr double kWidth = 11.345;  // 99 % quantile of chi2 in the plane, the default
  for (int seed = 1; seed <= 3; ++seed) {
    const Problem problem = driving(seed, 0.3).problem;
    Report report;
    PoseGraphOptimizer(kDcs).correct(problem, report);
    EXPECT_LE(test::count(report, "robust_chi2"),
              solved_directly(problem, kWidth).chi2 * (1.0 + 1e-9));
  }
}

TEST(BoundedLosses, SayThatMostClosuresHaveNoInfluence) {
  const Problem problem = driving(1, 0.0).problem;
  const auto notes = [&](double width) {
    Report report;
    PoseGraphOptimizer({.loss = RobustLoss::dcs, .loss_width = width}).correct(problem, report);
    return report.notes;
  };
  EXPECT_TRUE(notes(1e9).empty());
  // The width is far below the errors that odometry leaves.
  ASSERT_FALSE(notes(1e-6).empty());
  EXPECT_NE(notes(1e-6).front().find("closures have less than 5 % of their weight"),
            std::string::npos);
}

}  // namespace
}  // namespace loopbench::bounded_losses_test
