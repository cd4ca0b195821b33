// Dynamic covariance scaling and switchable constraints with default options.
#include <gtest/gtest.h>

#include "methods/correctors/pose_graph.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/counts.hpp"
#include "tests/support/simulated_drive.hpp"

namespace loopbench::bounded_losses_test {

using namespace methods;

namespace {

constexpr RobustLoss kBounded[] = {RobustLoss::dcs, RobustLoss::switchable};

Sequence driving(std::int64_t seed, double false_share) {
  return test::simulated_drive({.seed = seed, .false_share = false_share});
}

/// RMS position error [m], not aligned: the first pose is exact.
double error(const Sequence& sequence, const PoseGraphOptimizer::Options& options) {
  const Trajectory out = test::corrected<PoseGraphOptimizer>(sequence.problem, options);
  return test::rmse(out, test::at_stamps_of(out, sequence.reference));
}

TEST(BoundedLosses, KeepTrueClosuresOnADriveWith30PercentFalse) {
  for (const RobustLoss loss : kBounded) {
    double without = 0.0, robust = 0.0, narrow = 0.0;
    for (int seed = 1; seed <= 5; ++seed) {
      without += error(driving(seed, 0.0), {});
      robust += error(driving(seed, 0.3), {.loss = loss});
      narrow += error(driving(seed, 0.3), {.loss = loss, .loss_width = 1.0, .anneal = false});
    }
    EXPECT_GT(narrow, 2.0 * without) << to_text(loss);  // almost no gain over no correction
    EXPECT_LT(robust, 1.25 * without) << to_text(loss);
  }
}

TEST(BoundedLosses, CostLittleWhenAllClosuresAreTrue) {
  for (const RobustLoss loss : kBounded) {
    double plain = 0.0, robust = 0.0;
    for (int seed = 1; seed <= 5; ++seed) {
      plain += error(driving(seed, 0.0), {});
      robust += error(driving(seed, 0.0), {.loss = loss});
    }
    EXPECT_LT(robust, 1.1 * plain) << to_text(loss);
  }
}

TEST(BoundedLosses, TakeTheLowerOfBothMinima) {
  for (const RobustLoss loss : kBounded) {
    for (int seed = 1; seed <= 3; ++seed) {
      const Problem problem = driving(seed, 0.3).problem;
      const auto cost = [&](bool anneal) {
        Report report;
        PoseGraphOptimizer({.loss = loss, .anneal = anneal}).correct(problem, report);
        return test::count(report, "robust_chi2");
      };
      EXPECT_LE(cost(true), cost(false) * (1.0 + 1e-9)) << to_text(loss);
    }
  }
}

TEST(BoundedLosses, SayThatMostClosuresHaveNoInfluence) {
  const Problem problem = driving(1, 0.0).problem;
  const auto notes = [&](double width) {
    Report report;
    PoseGraphOptimizer({.loss = RobustLoss::switchable, .loss_width = width, .anneal = false})
        .correct(problem, report);
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
