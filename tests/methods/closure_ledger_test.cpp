#include "methods/correctors/closure_ledger.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "datasets/core/closure_parts.hpp"
#include "datasets/core/closure_places.hpp"
#include "methods/correctors/ledger/next_closures.hpp"
#include "methods/correctors/looped_chain.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/rounds.hpp"

namespace loopbench::test::closure_ledger_test {
namespace {

/// The ledger is exact to first order: errors of a real size leave a difference that is
/// proportional to them, here 4e-4 for deviations of 1e-3.
/// Solution with the stated covariances, and its chi2.
std::pair<Trajectory, double> solution(const Problem& problem) {
  Report report;
  PoseGraphOptimizer::Options options;
  options.start = PoseGraphOptimizer::Start::chordal;
  Trajectory out = corrected<PoseGraphOptimizer>(problem, options, &report);
  return {std::move(out), count(report, "chi2")};
}

/// Where the closure ends, from where the poses have its end.
Pose gap_at(const Edge& closure, const Trajectory& poses) {
  return closure.from_from_to.inverse() * poses[closure.from].world_from_body.inverse() *
         poses[closure.to].world_from_body;
}

/// Every number of every row, compared with solutions without the closure. Errors of the size of
/// `rounds(seed, 1e-6)` leave 1e-6 of them, by curvature and by the rounding of the solver.
void expect_solutions(const Problem& problem, double tolerance) {
  const ClosureLedger ledger = closure_ledger(problem);
  ASSERT_EQ(ledger.places, problem.closures.size());
  const auto [joint, chi2] = solution(problem);
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    SCOPED_TRACE(k);
    const auto [solved, chi2_without] = solution(without_closures(problem, {k}));
    const LedgerRow& row = ledger.rows[k];
    ASSERT_TRUE(row.predicted && row.moves);
    const Pose gap = gap_at(problem.closures[k], solved);
    EXPECT_NEAR(row.predicted->metres / gap.translation.norm(), 1.0, tolerance);
    EXPECT_NEAR(
        row.predicted->degrees * M_PI / 180.0 / log_so3(gap.rotation).norm(), 1.0, tolerance);
    EXPECT_NEAR(row.cost_drop / (chi2 - chi2_without), 1.0, tolerance);
    EXPECT_NEAR(row.moves->rms / rmse(solved, joint), 1.0, tolerance);
    EXPECT_NEAR(row.moves->max / largest_distance(solved, joint), 1.0, tolerance);
    EXPECT_FALSE(row.is_prediction_solved || row.is_drop_solved);
  }
}

/// The ledger is exact to first order: errors of a real size leave a difference that is
/// proportional to them, here 4e-4 for deviations of 1e-3.
TEST(ClosureLedger, PredictsAPlaceLikeASolutionWithoutIt) {
  expect_solutions(rounds(3, 1e-6), 3e-6);
}

TEST(ClosureLedger, IsThatOfTheLoopEquationsOfAChain) {
  const Problem problem = rounds(3);
  const NoiseModel noise = stated_noise_model(problem);
  Report unused;
  const LoopedChain chain = lowest_minimum(problem, noise, {.tolerance = 1e-14}, unused);
  const LoopEquations equations = chain.equations();
  const auto size = static_cast<Eigen::Index>(6 * problem.closures.size());
  const Eigen::MatrixXd inverse = equations.factor.solve(Eigen::MatrixXd::Identity(size, size));
  const Eigen::VectorXd lambda = equations.factor.solve(equations.jacobian.gap);
  const ClosureLedger ledger = closure_ledger(problem);
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(6 * k);
    const Matrix6 information = inverse.block<6, 6>(at, at);
    const Twist force = lambda.segment<6>(at);
    const double drop = force.dot(information.llt().solve(force));
    EXPECT_NEAR(ledger.rows[k].cost_drop / drop, 1.0, 1e-6) << k;
    EXPECT_NEAR(ledger.rows[k].predicted->chi2 / (drop / 6.0), 1.0, 1e-6) << k;
  }
}

TEST(ClosureLedger, ChecksTwoChainsThatOnlyClosuresJoin) {
  Problem problem = rounds(3, 1e-6);
  problem.odometry.erase(problem.odometry.begin() + 90);
  expect_solutions(problem, 3e-6);
  const ClosureLedger ledger = closure_ledger(problem);
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    const Edge& edge = problem.closures[k];
    const bool is_joined = edge.from > 90 || edge.to <= 90;
    EXPECT_EQ(ledger.rows[k].in_odometry.has_value(), is_joined) << k;
    EXPECT_EQ(ledger.rows[k].loop_length.has_value(), is_joined) << k;
  }
}

TEST(ClosureLedger, UsesAnchors) {
  Problem problem = rounds(3, 1e-6);
  const Trajectory solved = solution(problem).first;
  const Matrix3 covariance = 1e-10 * Matrix3::Identity();
  for (const std::size_t k : {0UL, 50UL, 100UL, 150UL}) {
    const Vector3 position = solved[k].world_from_body.translation + Vector3::Constant(1e-5);
    problem.anchors.push_back({.keyframe = k, .position = position, .covariance = covariance});
  }
  expect_solutions(problem, 1e-5);
}

TEST(ClosureLedger, LeavesOutOutlyingAnchors) {
  Problem problem = rounds(3);
  const Trajectory solved = solution(problem).first;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0.0, 0.05);
  for (std::size_t k = 0; k < problem.keyframes.size(); k += 6) {
    const Vector3 noise(normal(random), normal(random), normal(random));
    problem.anchors.push_back({.keyframe = k,
                               .position = solved[k].world_from_body.translation + noise,
                               .covariance = 0.0025 * Matrix3::Identity()});
  }
  Problem clean = problem;
  for (const std::size_t outlier : {7UL, 20UL}) {
    problem.anchors[outlier].position += Vector3(12.0, -9.0, 3.0);
    clean.anchors.erase(clean.anchors.begin() + static_cast<std::ptrdiff_t>(outlier) -
                        (outlier == 20 ? 1 : 0));
  }
  const ClosureLedger ledger = closure_ledger(problem), expected = closure_ledger(clean);
  ASSERT_TRUE(ledger.anchors && ledger.anchors->is_decided);
  for (std::size_t i = 0; i < problem.anchors.size(); ++i) {
    EXPECT_EQ(ledger.anchors->anchors[i].agrees, i != 7 && i != 20) << i;
  }
  EXPECT_NEAR(ledger.anchors->anchors[7].metres, std::sqrt(234.0), 0.5);
  EXPECT_EQ(ledger.verdict, LedgerVerdict::agrees);
  ASSERT_TRUE(expected.anchors);
  EXPECT_EQ(expected.anchors->agreeing, clean.anchors.size());
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    EXPECT_DOUBLE_EQ(ledger.rows[k].cost_drop, expected.rows[k].cost_drop) << k;
  }
  EXPECT_EQ(trusted_problem(problem, ledger).anchors.size(), clean.anchors.size());
}

TEST(ClosureLedger, StatesOneScalarLoopAnalytically) {
  // Four steps of 1 m with variance 1 each; closures 0 -> 4 measures 5 m, 0 -> 2 measures 2 m, both
  // with variance 1. All lie at one place, so nothing predicts the other.
  Problem problem = along_x({0, 1, 2, 3, 4});
  problem.closures.push_back({0, 2, at_x(2.0)});
  problem.closures.push_back({0, 4, at_x(5.0)});
  const ClosureLedger ledger = closure_ledger(problem);
  EXPECT_EQ(ledger.places, 1u);
  const LedgerRow& row = ledger.rows[1];
  EXPECT_NEAR(row.loop_length.value(), 4.0, 1e-12);
  EXPECT_NEAR(row.in_odometry->metres, 1.0, 1e-12);
  EXPECT_NEAR(row.in_odometry->chi2, 1.0 / 5.0 / 6.0, 1e-12);  // variance 4 + 1, six degrees
  const double variance = 4.0 + 1.0 - 2.0 * 2.0 / 3.0;         // given closure 0 -> 2
  EXPECT_NEAR(row.cost_drop, 1.0 / variance, 1e-9);
}

TEST(ClosureLedger, SaysThatACorrectionHelps) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const ClosureLedger ledger = closure_ledger(rounds(seed));
    EXPECT_EQ(ledger.verdict, LedgerVerdict::agrees) << seed;
    EXPECT_TRUE(ledger.helps) << seed << " ratio " << ledger.ratio;
  }
}

/// Closures next to the one at `closure`, derived from the odometry between.
Edge shifted(const Problem& problem, std::size_t closure, std::size_t shift) {
  Edge out = problem.closures[closure];
  Pose before, after;
  for (std::size_t i = 0; i < shift; ++i) {
    before = before * problem.odometry[out.from + i].from_from_to;
    after = after * problem.odometry[out.to + i].from_from_to;
  }
  out.from_from_to = normalized(before.inverse() * out.from_from_to * after);
  out.from += shift;
  out.to += shift;
  return out;
}

TEST(ClosureLedger, FindsAFalseClosureAmongItsNeighbours) {
  Problem problem = rounds(1);
  problem.closures = {shifted(problem, 2, 0),
                      shifted(problem, 2, 1),
                      shifted(problem, 2, 2),
                      shifted(problem, 3, 0)};
  problem.closures[1].from_from_to.translation.x() += 4.0;
  const ClosureLedger ledger = closure_ledger(problem);
  EXPECT_EQ(ledger.places, 2u);
  EXPECT_EQ(ledger.verdict, LedgerVerdict::disagrees);
  EXPECT_EQ(ledger.suspects[0], 1u);
  EXPECT_NE(ledger.finding(1), ClosureFinding::agrees);
  EXPECT_EQ(ledger.named, 1u);
}

TEST(ClosureLedger, SolvesWithoutTheClosureThatItNames) {
  Problem problem = rounds(1);
  Pose& measured = problem.closures[2].from_from_to;
  measured.rotation = measured.rotation * exp_so3({0.0, 0.0, 3.0});
  measured.translation += Vector3(8.0, 3.0, 0.0);
  const ClosureLedger ledger = closure_ledger(problem);
  ASSERT_EQ(ledger.verdict, LedgerVerdict::disagrees);
  ASSERT_EQ(ledger.suspects[0], 2u);
  const auto [joint, chi2] = solution(problem);
  const auto [others, chi2_without] = solution(without_closures(problem, {2}));
  const LedgerRow& row = ledger.rows[2];
  // Distances and angles, which the norms of a logarithm are not: it has 13 m.
  const Pose in_odometry = gap_at(problem.closures[2], problem.keyframes);
  EXPECT_NEAR(row.in_odometry->metres, in_odometry.translation.norm(), 1e-9);
  EXPECT_NEAR(row.in_odometry->degrees,
              angle_between(in_odometry.rotation, Rotation::Identity()) * 180.0 / M_PI,
              1e-9);
  EXPECT_TRUE(row.is_prediction_solved && row.is_drop_solved);
  EXPECT_NEAR(row.predicted->metres, gap_at(problem.closures[2], others).translation.norm(), 1e-6);
  EXPECT_NEAR(row.cost_drop / (chi2 - chi2_without), 1.0, 1e-9);
  EXPECT_NEAR(row.moves->rms, rmse(others, joint), 1e-6);
}

TEST(ClosureLedger, DoesNotBlameClosuresForSmallCovariances) {
  Problem problem = rounds(1);
  for (Edge& edge : problem.odometry) edge.information *= 400.0;
  for (Edge& edge : problem.closures) edge.information *= 400.0;
  EXPECT_EQ(closure_ledger(problem).verdict, LedgerVerdict::agrees);
}

TEST(ClosureLedger, ChecksTwoLapsByTheirParts) {
  Problem problem = rounds(1);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, kStepSigma);
  const Matrix6 information = problem.closures[0].information;
  problem.closures.clear();
  for (std::size_t k = 0; k < 50; ++k) {  // the same positions, one round later
    Twist noise;
    for (double& each : noise) each = normal(random);
    problem.closures.push_back({k, k + 60, exp_se3(noise), information});
  }
  const ClosureLedger ledger = closure_ledger(problem);
  EXPECT_GE(ledger.places, kMinPlaces);
  EXPECT_EQ(ledger.verdict, LedgerVerdict::agrees);
  for (const LedgerRow& row : ledger.rows) EXPECT_TRUE(row.predicted);
}

TEST(ClosureLedger, DeclinesWhatItDoesNotCover) {
  Problem problem = rounds(1);
  EXPECT_EQ(why_no_ledger(problem), "");
  problem.closures[0].scale = 1.1;
  EXPECT_EQ(why_no_ledger(problem), "edges change the scale, which the ledger does not estimate");
  problem.closures.clear();
  EXPECT_EQ(why_no_ledger(problem), "the problem has no loop closures");
  problem.anchors.push_back({3});
  EXPECT_EQ(why_no_ledger(problem), "");
  problem = rounds(1);
  problem.odometry.erase(problem.odometry.begin() + 170);
  EXPECT_TRUE(why_no_ledger(problem).starts_with("the graph is not connected"))
      << why_no_ledger(problem);
}

TEST(NextClosures, PredictTheDeviationWithOneMore) {
  Problem problem = rounds(1);
  problem.closures.resize(1);
  const NextClosures next = next_closures(problem);
  ASSERT_EQ(next.found.size(), 3u);
  EXPECT_LT(next.found[0].deviation, 0.9 * next.deviation);
  EXPECT_LE(next.found[0].deviation, next.found[1].deviation);
  const NextClosure& first = next.found[0];
  const Trajectory solved = solution(problem).first;
  const Pose between =
      solved[first.from].world_from_body.inverse() * solved[first.to].world_from_body;
  EXPECT_NEAR(first.metres, between.translation.norm(), 1e-9);
  problem.closures.push_back({first.from, first.to, between, problem.closures[0].information});
  EXPECT_NEAR(next_closures(problem).deviation / first.deviation, 1.0, 1e-6);
}

TEST(ClosureParts, AreBounded) {
  std::vector<Edge> closures;
  for (std::size_t k = 0; k < 50; ++k) closures.push_back({k, k + 60, {}});
  const auto parts = closure_parts(closures);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].size(), 21u);
  EXPECT_EQ(parts[2].front(), 42u);
  EXPECT_EQ(closure_parts(closures, {20, 10}).size(), 5u);
}

TEST(ClosurePlaces, JoinsClosuresThroughOthers) {
  const auto loop = [](std::size_t from, std::size_t to) { return Edge{from, to, {}}; };
  const std::vector<Edge> closures{loop(0, 100), loop(40, 140), loop(20, 120), loop(0, 160)};
  const std::vector<std::vector<std::size_t>> expected{{0, 1, 2}, {3}};
  EXPECT_EQ(closure_places(closures), expected);
}

TEST(ClosurePlaces, CoveredShareCountsPlacesNotClosures) {
  Problem problem = along_x({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  problem.closures = {{0, 6, at_x(6.0)}, {1, 7, at_x(6.0)}, {5, 10, at_x(5.0)}};
  EXPECT_DOUBLE_EQ(covered_share(problem, {{0, 1}, {2}}), 0.2);  // from 5 to 7
  EXPECT_DOUBLE_EQ(covered_share(problem, {{0, 1, 2}}), 0.0);
}

}  // namespace
}  // namespace loopbench::test::closure_ledger_test
