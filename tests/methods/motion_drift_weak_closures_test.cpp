// A closure with very low information must not change the influence of the others, and the unit of
// stated covariances must not change the result.
#include <gtest/gtest.h>

#include <numeric>

#include "methods/correctors/looped_chain.hpp"
#include "methods/correctors/motion_drift/loop_averages.hpp"
#include "methods/correctors/motion_drift/motion_drift.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/simulated_drive.hpp"

namespace loopbench::motion_drift_weak_closures_test {

using namespace methods;

namespace {

const MotionDrift::Options kAverage{.abstain_closures = 0};

using namespace test;

Matrix6 information_of(double sigma) { return Matrix6::Identity() / (sigma * sigma); }

Problem drive() { return simulated_drive({.closures = 6, .planar = false}).problem; }

Problem with_weak_closure(Problem problem, double sigma) {
  const std::size_t last = problem.keyframes.size() - 1;
  const Pose exact = problem.keyframes[last / 5].world_from_body.inverse() *
                     problem.keyframes[last].world_from_body;
  problem.closures.push_back({last / 5, last, normalized(exact), information_of(sigma)});
  return problem;
}

Eigen::VectorXd gap_of(const Problem& problem) {
  return LoopedChain(problem, stated_noise_model(problem)).linearise().gap;
}

/// Prior medians of all terms for default options.
MotionModel medians_of(const Problem& problem) {
  const MotionModel terms{{TermKind::noise, Component::translation, Regressor::distance},
                          {TermKind::noise, Component::rotation, Regressor::time},
                          {TermKind::stated, Component::rotation, Regressor::edge},
                          {TermKind::closures, Component::translation, Regressor::edge, 1.0},
                          {TermKind::closures, Component::rotation, Regressor::edge, 1.0}};
  return prior_of(terms, {}, problem, motions(problem), gap_of(problem)).hypotheses.back().medians;
}

TEST(MotionDriftWeakClosures, DoNotShrinkTheCovarianceOfTheOthers) {
  const Problem problem = drive();
  const MotionModel without = medians_of(problem);
  const MotionModel with = medians_of(with_weak_closure(problem, 1e5));
  ASSERT_EQ(without.size(), with.size());
  for (std::size_t j = 0; j < with.size(); ++j) {
    EXPECT_NEAR(with[j].value, without[j].value, 0.1 * without[j].value) << name_of(with[j]);
  }
  EXPECT_EQ(with[3].value, 1.0);  // before the fix: 1e-8
}

TEST(MotionDriftWeakClosures, EqualVariancesGiveEqualWeights) {
  Problem problem = drive();
  const std::vector<EdgeMotion> moved = motions(problem);
  double mean = 0.0;
  for (Edge& loop : problem.closures) {
    loop.information = information_of(0.3);
    const double metres =
        std::accumulate(moved.begin() + static_cast<std::ptrdiff_t>(loop.from),
                        moved.begin() + static_cast<std::ptrdiff_t>(loop.to),
                        0.0,
                        [](double sum, const EdgeMotion& edge) { return sum + edge.metres; });
    mean += metres / static_cast<double>(problem.closures.size());
  }
  const LoopAverages loops(problem, moved, gap_of(problem));
  EXPECT_NEAR(loops.stated(Component::rotation), 0.09, 1e-12);
  EXPECT_GE(loops.motion(Component::translation, Regressor::distance, false),
            mean);  // bound for slow loops
  EXPECT_NEAR(loops.motion(Component::translation, Regressor::distance, false), mean, 0.2 * mean);
}

TEST(MotionDriftWeakClosures, AWeakClosureDoesNotChangeTheTrajectory) {
  const Problem problem = drive();
  const Trajectory without = corrected<MotionDrift>(problem, kAverage);
  const double moved = largest_distance(without, problem.keyframes);
  for (const double sigma : {1e3, 1e5}) {
    const Trajectory with = corrected<MotionDrift>(with_weak_closure(problem, sigma), kAverage);
    EXPECT_LT(largest_distance(with, without), 0.2 * moved) << sigma;
  }
}

TEST(MotionDriftWeakClosures, DeviationsInAnotherUnitDoNotChangeTheTrajectory) {
  const Problem problem = drive();
  Problem scaled = problem;
  for (std::vector<Edge>* edges : {&scaled.odometry, &scaled.closures}) {
    for (Edge& edge : *edges) edge.information *= 1e-6;
  }
  const Trajectory out = corrected<MotionDrift>(problem, kAverage);
  const double moved = largest_distance(out, problem.keyframes);
  EXPECT_LT(largest_distance(corrected<MotionDrift>(scaled, kAverage), out), 0.2 * moved);
}

}  // namespace
}  // namespace loopbench::motion_drift_weak_closures_test
