// consensus: planted false closures singly, at random and in families, unknown steps, and what is
// left undecided. Its densities: consensus_model_test.cpp.
#include "methods/correctors/consensus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "datasets/derive/odometry.hpp"
#include "datasets/noise/random.hpp"
#include "methods/correctors/consensus/judge.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "methods/solvers/groups/se2.hpp"
#include "methods/solvers/groups/se3.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/measured_line.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/rounds.hpp"
#include "tests/support/simulated_drive.hpp"

namespace loopbench::test::consensus_test {
namespace {

using namespace methods::consensus;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Ends of the closures that are rejected.
std::vector<std::pair<std::size_t, std::size_t>> rejected(const Problem& problem,
                                                          Report* report = nullptr) {
  Report own;
  Report& used = report ? *report : own;
  corrected<Consensus>(problem, {}, &used);
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (const std::size_t k : *used.rejected) {
    out.emplace_back(problem.closures[k].from, problem.closures[k].to);
  }
  return out;
}

std::vector<std::size_t> rejected_indices(const Problem& problem) {
  Report report;
  corrected<Consensus>(problem, {}, &report);
  return *report.rejected;
}

TEST(Consensus, RejectsExactlyTheFalseClosuresOfADrive) {
  const Sequence clean = simulated_drive({.closures = 20});
  const double without = rmse(corrected<Consensus>(clean.problem),
                              at_stamps_of(clean.problem.keyframes, clean.reference));
  for (const double share : {0.2, 0.4}) {
    const Sequence mixed = simulated_drive({.closures = 20, .false_share = share});
    Report report;
    const Trajectory done = corrected<Consensus>(mixed.problem, {}, &report);
    EXPECT_EQ(count(report, "decided"), 1.0);
    const std::size_t planted = mixed.problem.closures.size() - clean.problem.closures.size();
    EXPECT_EQ(report.rejected->size(), planted) << share;
    EXPECT_LT(rmse(done, at_stamps_of(done, mixed.reference)), 1.1 * without) << share;
  }
}

TEST(Consensus, DoesNotDependOnTheScaleOfStatedDeviations) {
  const Sequence mixed = simulated_drive({.closures = 12, .false_share = 0.3});
  Report report;
  const auto expected = rejected(mixed.problem, &report);
  const double factor = count(report, "factor_r");
  for (const double scale : {0.1, 10.0}) {
    Problem stated = mixed.problem;
    for (Edge& edge : stated.odometry) edge.information /= scale * scale;
    Report scaled;
    EXPECT_EQ(rejected(stated, &scaled), expected) << scale;
    EXPECT_NEAR(count(scaled, "factor_r") * scale / factor, 1.0, 0.35) << scale;
  }
}

TEST(Consensus, DoesNotDependOnTheOrderOfClosures) {
  Problem problem = simulated_drive({.closures = 10, .false_share = 0.3}).problem;
  auto expected = rejected(problem);
  std::ranges::reverse(problem.closures);
  auto found = rejected(problem);
  std::ranges::sort(expected);
  std::ranges::sort(found);
  EXPECT_EQ(found, expected);
}

TEST(Consensus, RejectsAFamilyThatAgrees) {
  const Sequence clean = simulated_drive({.closures = 12});
  Problem problem = clean.problem;
  const Trajectory truth = at_stamps_of(problem.keyframes, clean.reference);
  const auto pose = [&](std::size_t k) { return truth[k].world_from_body; };
  const Pose measured = problem.closures.front().from_from_to;
  const Pose wrong = pose(30) * measured * pose(120).inverse();
  for (std::size_t i = 0; i < 8; i += 2) {  // the same wrong place, entered four times
    problem.closures.push_back({30 + i,
                                120 + i,
                                normalized(pose(30 + i).inverse() * wrong * pose(120 + i)),
                                problem.closures.front().information});
  }
  std::ranges::sort(problem.closures, {}, [](const Edge& e) { return std::pair(e.to, e.from); });
  EXPECT_THAT(rejected(problem),
              testing::UnorderedElementsAre(std::pair(30UL, 120UL),
                                            std::pair(32UL, 122UL),
                                            std::pair(34UL, 124UL),
                                            std::pair(36UL, 126UL)));
}

TEST(Consensus, KeepsASingleClosureThatTheOdometryAllows) {
  EXPECT_THAT(rejected(measured_line(40, {40.2})), IsEmpty());
  Report report;
  Problem far = measured_line(40, {2.0});
  far.closures.front().from_from_to = turned_about_z(1.0, {2.0, 3.0, 0.0});
  EXPECT_EQ(rejected(far, &report).size(), 1u);
  EXPECT_EQ(count(report, "decided"), 0.0);
  expect_close(corrected<Consensus>(far), far.keyframes, 0.0);
}

TEST(Consensus, LeavesRivalsOfEqualSizeUndecided) {
  // Of one pair of keyframes, 3 m too far and 3 m too near.
  Problem problem = measured_line(40, {});
  for (const double metres : {43.0, 37.0}) {
    problem.closures.push_back({0, 40, at_x(metres), isotropic_information(1e-6, 1e-8)});
  }
  const ClosureJudgement found = judge_closures(problem);
  EXPECT_EQ(found.outcome, ConsensusOutcome::rival);
  EXPECT_GE(found.more_needed, 1u);
  expect_close(corrected<Consensus>(problem), problem.keyframes, 0.0);
}

TEST(Consensus, JoinsPartsWithoutOdometryBetween) {
  const Sequence drive = simulated_drive({.closures = 20});
  Problem problem = drive.problem;
  // Tracking is lost after keyframe 100 and starts again at the origin.
  const Trajectory complete = corrected<Consensus>(problem);
  std::erase_if(problem.odometry, [](const Edge& edge) { return edge.from == 100; });
  const Pose moved = problem.keyframes[101].world_from_body.inverse();
  for (std::size_t k = 101; k < problem.keyframes.size(); ++k) {
    problem.keyframes[k].world_from_body = normalized(moved * problem.keyframes[k].world_from_body);
  }
  Report report;
  const Trajectory joined = corrected<Consensus>(problem, {}, &report);
  EXPECT_THAT(*report.rejected, IsEmpty());
  // The step is unknown, so that the odometry no longer holds the parts together: metres on 1 km.
  EXPECT_LT(largest_distance(joined, complete), 5.0);
}

TEST(StepWeights, AreHighestWhereAStepIsUnlikeBothNeighbours) {
  Problem problem = along_x({0.0, 1.0, 2.0, 3.1, 4.1, 4.1, 5.1, 6.2, 7.2});  // stands from 4 to 5
  const std::vector<double> found = log_step_weights(problem);
  ASSERT_EQ(found.size(), 8u);
  double sum = 0.0;
  for (const double each : found) sum += std::exp(each);
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_EQ(std::ranges::max_element(found) - found.begin(), 4);
  EXPECT_GT(found[4], found[3] + std::log(50.0));
  EXPECT_GT(found[4], found[5] + std::log(50.0));
  std::erase_if(problem.odometry, [](const Edge& edge) { return edge.from == 4; });
  EXPECT_EQ(log_step_weights(problem)[4], -std::numeric_limits<double>::infinity());
}

/// The drive with another motion from keyframe `from` to the next.
Problem with_step(Problem problem, std::size_t from, const Pose& motion) {
  problem.odometry[from].from_from_to = normalized(motion);
  const Pose moved = problem.keyframes[from].world_from_body * motion *
                     problem.keyframes[from + 1].world_from_body.inverse();
  for (std::size_t k = from + 1; k < problem.keyframes.size(); ++k) {
    problem.keyframes[k].world_from_body = normalized(moved * problem.keyframes[k].world_from_body);
  }
  return problem;
}

TEST(Consensus, FreesAStepThatSlipped) {
  const Sequence drive = simulated_drive({.closures = 20});
  const Problem& right = drive.problem;
  const Pose slip = turned_about_z(0.4, {3.0, 0.5, 0.0});
  const Problem problem = with_step(right, 90, right.odometry[90].from_from_to * slip);
  const ClosureJudgement found = judge_closures(problem);
  ASSERT_EQ(found.steps.size(), 1u);
  EXPECT_EQ(found.steps.front().from, 90u);
  EXPECT_GT(found.steps.front().log_odds, kLogNeeded);
  EXPECT_NEAR(found.steps.front().metres, slip.translation.norm(), 2.0);  // with drift
  EXPECT_NEAR(found.steps.front().degrees, 0.4 * 180.0 / M_PI, 2.0);
  Report report;
  const Trajectory done = corrected<Consensus>(problem, {}, &report);
  EXPECT_EQ(*report.rejected, rejected_indices(right));
  EXPECT_EQ(count(report, "steps_freed"), 1.0);
  EXPECT_THAT(report.notes, testing::Contains(HasSubstr("times its deviation")));
  const Trajectory truth = at_stamps_of(done, drive.reference);
  EXPECT_LT(rmse(done, truth), 1.2 * rmse(corrected<Consensus>(right), truth));
}

TEST(Consensus, FreesTheStepAfterWhichTheMapStartsAgain) {
  const Problem right = simulated_drive({.closures = 20, .planar = false}).problem;
  const Pose restart =
      right.keyframes[90].world_from_body.inverse() * right.keyframes.front().world_from_body;
  const ClosureJudgement found = judge_closures(with_step(right, 90, restart));
  ASSERT_EQ(found.steps.size(), 1u);
  EXPECT_EQ(found.steps.front().from, 90u);
  EXPECT_TRUE(std::isinf(found.steps.front().inflation));
  EXPECT_EQ(found.agreeing, 20u);
}

TEST(Consensus, FreesNoStepOfARightDrive) {
  for (const std::int64_t seed : {1, 2, 3}) {
    for (const double share : {0.0, 0.3}) {
      const Problem right =
          simulated_drive({.closures = 16, .seed = seed, .false_share = share}).problem;
      EXPECT_THAT(judge_closures(right).steps, IsEmpty()) << seed << " " << share;
    }
  }
}

TEST(Consensus, TakesClosuresDerivedFromTheOdometryForNoEvidence) {
  Problem problem = rounds(3);
  const std::vector<Edge> measured = problem.closures;
  for (std::size_t k = 0; k + 3 < problem.keyframes.size(); k += 2) {
    const Pose motion = problem.odometry[k].from_from_to * problem.odometry[k + 1].from_from_to *
                        problem.odometry[k + 2].from_from_to;
    problem.closures.push_back({k, k + 3, normalized(motion), measured.front().information});
  }
  std::ranges::sort(problem.closures, {}, [](const Edge& e) { return std::pair(e.to, e.from); });
  Report report;
  EXPECT_THAT(rejected(problem, &report), IsEmpty());
  EXPECT_GT(count(report, "factor_r"), 0.2);
  EXPECT_LT(count(report, "factor_r"), 5.0);
}

TEST(Consensus, DropsFalseClosuresAmongHundreds) {
  SimulatedOptions options;
  options.path = SimulatedPath::driving;
  options.planar = true;
  options.laps = 4;
  options.keyframes = 600;
  options.stream = "shared";  // equal chain and true closures with and without false closures
  options.closures.max = 300;
  const Sequence clean = load_simulated(options);
  options.closures.false_share = 0.3;
  const Sequence mixed = load_simulated(options);
  const std::size_t planted = mixed.problem.closures.size() - clean.problem.closures.size();
  ASSERT_GT(planted, 50u);
  Report report;
  const Trajectory done = corrected<Consensus>(mixed.problem, {}, &report);
  EXPECT_NEAR(static_cast<double>(report.rejected->size()),
              static_cast<double>(planted),
              0.04 * static_cast<double>(mixed.problem.closures.size()));
  const double without = rmse(corrected<PoseGraphOptimizer>(clean.problem),
                              at_stamps_of(clean.problem.keyframes, clean.reference));
  EXPECT_LT(rmse(done, at_stamps_of(done, mixed.reference)), 1.2 * without);
}

TEST(Consensus, DropsAWrongPlaceWhoseRivalsWereNotSearched) {
  Random random({1, 1}, Purpose::odometry);
  const auto noisy = [&](const Pose& motion, double sigma_t, double sigma_r) {
    Twist error = random.normal_twist(sigma_t, sigma_r);
    error.segment<3>(2).setZero();
    return normalized(motion * exp_se3(error));
  };
  Problem problem = measured_line(110, {});
  problem.planar = true;
  for (Edge& edge : problem.odometry) {
    edge.from_from_to = noisy(at_x(1.0), 0.1, 0.002);
    edge.information = isotropic_information(0.01, 4e-6);
    problem.keyframes[edge.to].world_from_body =
        normalized(problem.keyframes[edge.from].world_from_body * edge.from_from_to);
  }
  const auto add = [&](std::size_t from, std::size_t to, double error) {
    const Pose motion = at_x(static_cast<double>(to - from) + error);
    problem.closures.push_back(
        {from, to, noisy(motion, 0.02, 0.002), isotropic_information(4e-4, 4e-6)});
  };
  // Of 64 closures each second one is searched. Of those that span everything, these are the wrong
  // ones, 0.8 m off, which odometry allows; five true ones are compared later.
  for (std::size_t k = 0; k < 54; ++k) add(10 + k, 30 + k, 0.0);
  for (std::size_t k = 0; k < 10; ++k) {
    const bool is_wrong = k == 1 || k == 3, is_short = k % 2 == 1 && !is_wrong;
    add(is_short ? 80 + k : k, 90 + k, is_wrong ? 0.8 : 0.0);
  }
  ASSERT_EQ(evenly_chosen({0, 1, 2, 3}, 2), (std::vector<std::size_t>{1, 3}));
  ASSERT_EQ(problem.closures.size(), 2 * kSearched<Se2>);
  EXPECT_THAT(rejected(problem), ElementsAre(std::pair(1UL, 91UL), std::pair(3UL, 93UL)));
}

TEST(Consensus, DeclinesSim3AndNamesPoseGraph) {
  const Consensus method({});
  EXPECT_EQ(method.why_declined(with_anchors(circle(), {0.1, 0.0, 0.0})), "");
  Problem scaled = circle();
  scaled.closures.front().scale = 1.1;
  EXPECT_THAT(method.why_declined(scaled), HasSubstr("pose_graph"));
  Problem sparse = circle();
  sparse.odometry.clear();
  EXPECT_NE(method.why_declined(sparse), "");
}

}  // namespace
}  // namespace loopbench::test::consensus_test
