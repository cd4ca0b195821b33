// Splines fitted with Ceres: spline_regression to poses, spline_fit to odometry and closures.
#include "methods/joint/spline_fit.hpp"

#include <gtest/gtest.h>

#include "methods/correctors/pose_graph.hpp"
#include "methods/smoothers/interpolating_splines.hpp"
#include "methods/smoothers/spline/basis.hpp"
#include "methods/smoothers/spline_regression.hpp"
#include "methods/solvers/spline_solver.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/counts.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::spline_fit_test {

using namespace methods;

namespace {

using namespace test;

TEST(SplineFactor, JacobiansAgreeWithDifferences) {
  std::mt19937_64 random(4);
  const SplineBasis basis(5, {0.0, 1.0, 1.5, 3.0, 4.0, 5.0, 7.0});
  std::vector<Pose> all;
  for (std::size_t j = 0; j < basis.size(); ++j) {
    const auto s = static_cast<double>(j);
    all.push_back(
        exp_se3(random_twist(random, 1.0, 0.3) + twist({1.0 * s, 0, 0}, {0, 0, 0.2 * s})));
  }
  Edge edge{0, 1, exp_se3(random_twist(random, 1.0, 0.4)), Matrix6::Identity()};
  const std::array factors{SplineFactor(basis, PoseAt{2.2, exp_se3(random_twist(random, 1, 1))}),
                           SplineFactor(basis, PoseAt{7.0, all.back()}),
                           SplineFactor(basis, EdgeBetween{0.7, 1.2, edge}),   // share controls
                           SplineFactor(basis, EdgeBetween{0.2, 6.5, edge})};  // few or none
  for (const SplineFactor& factor : factors) {
    std::vector<Pose> controls;
    for (const std::size_t j : factor.controls()) controls.push_back(all[j]);
    const auto evaluated = factor.evaluate(controls);
    constexpr double step = 1e-6;
    for (std::size_t j = 0; j < controls.size(); ++j) {
      for (int axis = 0; axis < 6; ++axis) {
        const auto moved = [&](double by) {
          auto moved_controls = controls;
          const Twist d = by * Twist::Unit(axis);
          moved_controls[j].translation += d.head<3>();
          moved_controls[j].rotation = exp_so3(d.tail<3>()) * moved_controls[j].rotation;
          return factor.evaluate(moved_controls).error;
        };
        const Twist numeric = (moved(step) - moved(-step)) / (2.0 * step);
        EXPECT_LT((numeric - evaluated.by_control[j].col(axis)).norm(), 2e-8) << j << ", " << axis;
      }
    }
  }
}

TEST(Knots, OnePerKeyframeEqualInterpolation) {
  const std::vector<double> times = stamps(hand_held_truth(20));
  EXPECT_EQ(basis_with_fewer_knots(4, times, 1.0).breaks(),
            SplineBasis::for_sites(4, times).breaks());
  EXPECT_EQ(basis_with_fewer_knots(4, times, 0.5).size(), 10u);
  EXPECT_EQ(basis_with_fewer_knots(6, times, 0.01).size(), 6u);
}

TEST(SplineRegression, WithOneKnotPerKeyframeInterpolates) {
  Problem problem;
  problem.keyframes = hand_held_truth(25);
  Report report;
  const auto fitted = SplineRegression({.knots_per_keyframe = 1.0}).smooth(problem, report);
  const auto through = BSplineThrough({}).smooth(problem, report);
  for (double time = problem.keyframes.front().stamp; time < problem.keyframes.back().stamp;
       time += 0.05) {
    EXPECT_TRUE(is_close(fitted->at(time), through->at(time), 1e-7, 1e-7)) << time;
  }
}

TEST(SplineRegression, WithFewKnotsReproducesSplines) {
  // Cubic position and cubic angle about one axis: any cubic spline can represent them.
  const auto truth = [](double s) {
    return Pose{exp_so3((0.3 * s - 0.2 * s * s + 0.05 * s * s * s) * Vector3(1, -2, 2) / 3.0),
                {1.0 + s, 2.0 - 0.5 * s * s, 0.1 * s * s * s}};
  };
  Problem problem;
  for (int i = 0; i < 20; ++i) {
    const double time = 0.2 * i + (i % 2 == 0 ? 0.05 : 0.0);
    problem.keyframes.push_back({time, truth(time)});
  }
  Report report;
  const auto curve = SplineRegression({.knots_per_keyframe = 0.35}).smooth(problem, report);
  EXPECT_EQ(count(report, "controls"), 7.0);
  for (double time = 0.05; time < 3.8; time += 0.03) {
    EXPECT_TRUE(is_close(curve->at(time), truth(time), 1e-8, 1e-8)) << time;
  }
}

TEST(SplineFit, WithOneKnotPerKeyframeInterpolatesThePoseGraphOptimum) {
  for (const Problem& problem : {walk(3, 30, 0.02), hand_held()}) {
    Report report;
    const auto curve = SplineFit({}).estimate(problem, report);
    const Trajectory optimum = corrected<PoseGraphOptimizer>(problem);
    expect_close(curve->sample(stamps(optimum)), optimum, 1e-5);
    const double chi2 = 2.0 * chain_cost(problem, poses_of(optimum));
    EXPECT_NEAR(count(report, "chi2"), chi2, 1e-6 * chi2);
  }
}

TEST(SplineFit, WithFewerKnotsHasAHigherCost) {
  const Problem problem = hand_held();
  Report every, fewer;
  SplineFit({}).estimate(problem, every);
  const auto curve = SplineFit({.knots_per_keyframe = 0.6}).estimate(problem, fewer);
  EXPECT_GT(count(fewer, "chi2"), count(every, "chi2"));
  EXPECT_LT(count(fewer, "chi2"), count(fewer, "chi2_before"));
  EXPECT_EQ(count(fewer, "controls"), 36.0);
  // The start is fixed.
  EXPECT_TRUE(
      is_close(curve->at(curve->start()), problem.keyframes[0].world_from_body, 1e-9, 1e-9));
}

}  // namespace
}  // namespace loopbench::spline_fit_test
