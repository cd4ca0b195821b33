// consensus: densities worked by hand, and equal results of its factorisations.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "methods/correctors/consensus/judge.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "methods/solvers/groups/se2.hpp"
#include "methods/solvers/groups/se3.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/measured_line.hpp"
#include "tests/support/rounds.hpp"
#include "tests/support/simulated_drive.hpp"

namespace loopbench::test::consensus_model_test {
namespace {

using namespace methods::consensus;

std::vector<std::size_t> indices(std::size_t count) {
  std::vector<std::size_t> out(count);
  std::iota(out.begin(), out.end(), std::size_t{0});
  return out;
}

TEST(ErrorDensity, IsThatOfTheNormalDistribution) {
  const Vector3 error(1.0, 2.0, 2.0);
  const Matrix3 covariance = Vector3(1.0, 4.0, 4.0).asDiagonal();
  const ErrorDensity found = normal_density(error, covariance);
  EXPECT_NEAR(found.squared, 3.0, 1e-12);
  EXPECT_NEAR(found.log_density, -1.5 - 1.5 * std::log(2.0 * M_PI) - std::log(4.0), 1e-12);
  EXPECT_FALSE(std::isfinite(normal_density(error, Matrix3(-covariance)).log_density));
}

TEST(CycleModel, AddsTheVariancesOfTheStepsOfALoop) {
  const Problem problem = measured_line(10, {10.3});
  const std::vector<std::size_t> all = indices(1);
  const ReducedChain<Se3> chain = reduced_chain<Se3>(problem, all);
  const CycleModel<Se3> model(chain, chain.poses);
  EXPECT_NEAR(model.rho(0)[0], 0.3, 1e-12);
  const auto variance = [&](const LogFactors& at) {
    return Elimination<Se3>(model, at).covariance(0)(0, 0);
  };
  EXPECT_NEAR(variance({}), 10 * 4e-4 + 4e-4, 1e-12);
  EXPECT_NEAR(variance({std::log(3.0), 0.0, 0.0}), 9 * 10 * 4e-4 + 4e-4, 1e-12);
  EXPECT_NEAR(variance({0.0, 0.0, std::log(2.0)}), 10 * 4e-4 + 4 * 4e-4, 1e-12);
}

template <class G>
void expect_equal_densities(const Problem& problem) {
  const std::vector<std::size_t> all = indices(problem.closures.size());
  const ReducedChain<G> chain = reduced_chain<G>(problem, all);
  const CycleModel<G> model(chain, chain.poses);
  const LogFactors at{0.3, -0.4, 0.2};
  Elimination<G> eliminated(model, at);
  std::vector<std::size_t> order = all;
  std::ranges::reverse(order);
  ASSERT_TRUE(eliminated.condition_on(order));
  EXPECT_NEAR(eliminated.log_odds(),
              LoopLikelihood(model, all).log_odds(at),
              1e-7 * static_cast<double>(problem.keyframes.size()));
  // Without each loop: by elimination of all others.
  const JointLoops<G> joint(model, at, all);
  const std::vector<LeftOut<G>> without = joint.left_out();
  for (const std::size_t a : all) {
    Elimination<G> others(model, at);
    for (const std::size_t b : all) {
      if (b != a) ASSERT_TRUE(others.condition_on(b));
    }
    const double size = 1.0 + without[a].covariance.norm();
    EXPECT_LT((others.error(a) - without[a].error).norm(), 1e-8 * size);
    EXPECT_LT((others.covariance(a) - without[a].covariance).norm(), 1e-8 * size);
  }
}

TEST(Elimination, HasTheDensitiesOfTheJointCovariance) {
  expect_equal_densities<Se3>(rounds(1));
  expect_equal_densities<Se2>(simulated_drive({.closures = 6}).problem);
}

TEST(LeftOutClosures, AreThoseOfTheChainModel) {
  const Problem problem = measured_line(10, {10.3, 7.9, 6.2});
  std::vector<ScaledPose> poses;
  for (const StampedPose& each : corrected<PoseGraphOptimizer>(problem)) {
    poses.push_back({each.world_from_body, 1.0});
  }
  const auto found = left_out_closures<Se3>(poses, problem);
  const std::vector<std::size_t> all = indices(3);
  const ReducedChain<Se3> chain = reduced_chain<Se3>(problem, all);
  const CycleModel<Se3> model(chain, chain.poses);
  const JointLoops<Se3> joint(model, {}, all);
  const std::vector<LeftOut<Se3>> expected = joint.left_out();
  double redundancy = 0.0;
  for (const std::size_t k : all) {
    ASSERT_TRUE(found[k]);
    EXPECT_NEAR(std::abs(found[k]->error[0]), std::abs(expected[k].error[0]), 1e-6);
    EXPECT_NEAR(found[k]->covariance(0, 0), expected[k].covariance(0, 0), 1e-9);
    redundancy += found[k]->redundancy;
  }
  EXPECT_GT(redundancy, 0.0);
  EXPECT_LT(redundancy, 18.0);  // the odometry has the rest
}

}  // namespace
}  // namespace loopbench::test::consensus_model_test
