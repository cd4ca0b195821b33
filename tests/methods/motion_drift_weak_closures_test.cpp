// One closure that states next to nothing must not change what the others say; nor must the unit
// that covariances are stated in.
#include <gtest/gtest.h>

#include <numeric>

#include "datasets/simulated/simulated.hpp"
#include "methods/correctors/looped_chain.hpp"
#include "methods/correctors/motion_drift/loop_averages.hpp"
#include "methods/correctors/motion_drift/motion_drift.hpp"
#include "tests/support/problems.hpp"

namespace loopbench {
namespace {

Matrix6 information_of(double sigma) { return Matrix6::Identity() / (sigma * sigma); }

Problem drive() {
  SimulatedOptions options;
  options.path = SimulatedPath::driving;
  options.closures.max = 6;
  return load_simulated(options).problem;
}

Problem with_weak_closure(Problem problem, double sigma) {
  const std::size_t last = problem.keyframes.size() - 1;
  const Pose seen = problem.keyframes[last / 5].world_from_body.inverse() *
                    problem.keyframes[last].world_from_body;
  problem.closures.push_back({last / 5, last, normalized(seen), information_of(sigma)});
  return problem;
}

Eigen::VectorXd gap_of(const Problem& problem) {
  return LoopedChain(problem, stated_belief(problem)).linearised().gap;
}

double largest_distance(const Trajectory& a, const Trajectory& b) {
  double out = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    out =
        std::max(out, (a[i].world_from_body.translation - b[i].world_from_body.translation).norm());
  }
  return out;
}

Trajectory corrected(const Problem& problem) {
  Report report;
  return MotionDrift({}).correct(problem, report);
}

TEST(MotionDriftWeakClosures, ChangeNoAverageOverTheLoops) {
  const Problem problem = drive();
  const std::vector<EdgeMotion> moved = motions(problem);
  const LoopAverages without(problem, moved, gap_of(problem));
  const Problem weak = with_weak_closure(problem, 1e5);
  const LoopAverages with(weak, moved, gap_of(weak));
  for (const Half half : {Half::translation, Half::rotation}) {
    // The median gap, which weights hang on, may move by one place.
    EXPECT_NEAR(with.gap(half), without.gap(half), 0.05 * without.gap(half));
    EXPECT_NEAR(with.stated(half), without.stated(half), 0.05 * without.stated(half));
    const double metres = without.motion(half, Growth::distance, true);
    EXPECT_NEAR(with.motion(half, Growth::distance, true), metres, 0.05 * metres);
  }
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
  EXPECT_NEAR(loops.stated(Half::rotation), 0.09, 1e-12);
  EXPECT_GE(loops.motion(Half::translation, Growth::distance, false), mean);  // floored where slow
  EXPECT_NEAR(loops.motion(Half::translation, Growth::distance, false), mean, 0.2 * mean);
}

TEST(MotionDriftWeakClosures, AWeakClosureLeavesTheTrajectory) {
  const Problem problem = drive();
  const Trajectory without = corrected(problem);
  const double moved = largest_distance(without, problem.keyframes);
  for (const double sigma : {1e3, 1e5}) {
    const Trajectory with = corrected(with_weak_closure(problem, sigma));
    EXPECT_LT(largest_distance(with, without), 0.2 * moved) << sigma;
  }
}

TEST(MotionDriftWeakClosures, AllSigmasInAnotherUnitLeaveTheTrajectory) {
  const Problem problem = drive();
  Problem scaled = problem;
  for (std::vector<Edge>* edges : {&scaled.odometry, &scaled.closures}) {
    for (Edge& edge : *edges) edge.information *= 1e-6;
  }
  const Trajectory out = corrected(problem);
  const double moved = largest_distance(out, problem.keyframes);
  EXPECT_LT(largest_distance(corrected(scaled), out), 0.2 * moved);
}

}  // namespace
}  // namespace loopbench
