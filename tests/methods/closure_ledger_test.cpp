#include "methods/correctors/closure_ledger.hpp"

#include <gtest/gtest.h>

#include "datasets/core/closure_places.hpp"
#include "methods/correctors/dual.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/rounds.hpp"

namespace loopbench::test::closure_ledger_test {
namespace {

/// The ledger is exact to first order: errors of a real size leave a difference that is
/// proportional to them, here 4e-4 for deviations of 1e-3.
TEST(ClosureLedger, PredictsAPlaceLikeASolutionWithoutIt) {
  const Problem problem = rounds(3, 1e-7);  // linear to the tolerance
  const Dual dual({.tolerance = 1e-14});
  Report with_report;
  const Trajectory joint = dual.correct(problem, with_report);
  const ClosureLedger ledger = closure_ledger(problem);
  ASSERT_EQ(ledger.places, problem.closures.size());
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    SCOPED_TRACE(k);
    Problem rest = problem;
    rest.closures.erase(rest.closures.begin() + static_cast<std::ptrdiff_t>(k));
    Report without_report;
    const Trajectory solved = dual.correct(rest, without_report);
    const Edge& loop = problem.closures[k];
    const Twist error =
        edge_error(loop, solved[loop.from].world_from_body, solved[loop.to].world_from_body);
    const LedgerRow& row = ledger.rows[k];
    EXPECT_NEAR(row.predicted->metres / error.head<3>().norm(), 1.0, 1e-6);
    const double drop = count(with_report, "chi2") - count(without_report, "chi2");
    EXPECT_NEAR(row.cost_drop / drop, 1.0, 1e-6);
    EXPECT_NEAR(row.moves_rms / rmse(solved, joint), 1.0, 1e-6);
    EXPECT_NEAR(row.moves_max / largest_distance(solved, joint), 1.0, 1e-6);
  }
}

TEST(ClosureLedger, StatesOneScalarLoopAnalytically) {
  // Four steps of 1 m with variance 1 each; closures 0 -> 4 measures 5 m, 0 -> 2 measures 2 m, both
  // with variance 1. All lie at one place, so nothing predicts the other.
  Problem problem = along_x({0, 1, 2, 3, 4});
  problem.closures.push_back({0, 2, at_x(2.0)});
  problem.closures.push_back({0, 4, at_x(5.0)});
  const ClosureLedger ledger = closure_ledger(problem);
  EXPECT_EQ(ledger.places, 1u);
  EXPECT_EQ(ledger.verdict, LedgerVerdict::few_places);
  const LedgerRow& row = ledger.rows[1];
  EXPECT_NEAR(row.loop_length, 4.0, 1e-12);
  EXPECT_NEAR(row.in_odometry.metres, 1.0, 1e-12);
  EXPECT_NEAR(row.in_odometry.chi2, 1.0 / 5.0 / 6.0, 1e-12);  // variance 4 + 1, six degrees
  EXPECT_FALSE(row.predicted);
  // Without it the chain keeps its odometry: gap 1, variance 2 * (1 / (2 / 2 + 1 / 1)) ...
  const double variance = 4.0 + 1.0 - 2.0 * 2.0 / 3.0;  // given closure 0 -> 2
  EXPECT_NEAR(row.cost_drop, 1.0 / variance, 1e-9);
}

TEST(ClosureLedger, SaysThatACorrectionHelps) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const ClosureLedger ledger = closure_ledger(rounds(seed));
    EXPECT_EQ(ledger.verdict, LedgerVerdict::helps) << seed << " ratio " << ledger.ratio;
  }
}

TEST(ClosureLedger, FindsAFalseClosureAmongItsNeighbours) {
  Problem problem = rounds(1);
  const Edge& loop = problem.closures[2];
  const auto add = [&](std::size_t shift) {
    Edge near = loop;
    near.from += shift, near.to += shift;
    Pose between;
    for (std::size_t i = near.from; i < near.to; ++i) {
      between = normalized(between * problem.odometry[i].from_from_to);
    }
    near.from_from_to = between;
    return near;
  };
  problem.closures = {add(0), add(1), add(2)};
  problem.closures[1].from_from_to.translation.x() += 4.0;
  const ClosureLedger ledger = closure_ledger(problem);
  EXPECT_EQ(ledger.places, 1u);
  EXPECT_EQ(ledger.verdict, LedgerVerdict::contradiction);
  EXPECT_EQ(ledger.suspects[0], 1u);
}

TEST(ClosureLedger, TellsSmallCovariancesFromFalseClosures) {
  Problem problem = rounds(1);
  for (Edge& edge : problem.odometry) edge.information *= 400.0;
  for (Edge& edge : problem.closures) edge.information *= 400.0;
  EXPECT_EQ(closure_ledger(problem).verdict, LedgerVerdict::covariances);
}

TEST(ClosureLedger, DeclinesWhatItDoesNotCover) {
  Problem problem = rounds(1);
  EXPECT_EQ(why_no_ledger(problem), "");
  problem.closures[0].scale = 1.1;
  EXPECT_EQ(why_no_ledger(problem), "edges change the scale, which the ledger does not estimate");
  problem.closures.clear();
  EXPECT_EQ(why_no_ledger(problem), "the problem has no loop closures");
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
