#include "methods/correctors/pose_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/dual.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench {
namespace {

using test::random_information;
using test::random_twist;
using test::walk;
using Options = PoseGraphOptimizer::Options;

Trajectory corrected(const Problem& problem, const Options& options = {}) {
  Report report;
  return PoseGraphOptimizer(options).correct(problem, report);
}

std::vector<Pose> poses(const Trajectory& trajectory) {
  std::vector<Pose> out;
  for (const StampedPose& p : trajectory) out.push_back(p.world_from_body);
  return out;
}

double worst_difference(const Trajectory& a, const Trajectory& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Twist d = log_se3(a[i].world_from_body.inverse() * b[i].world_from_body);
    worst = std::max(worst, d.norm());
  }
  return worst;
}

TEST(PoseGraph, EqualsDualOnAChain) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Problem problem = walk(seed, 200, 0.02);
    Report report;
    const Trajectory dual =
        Dual({.max_iterations = 200, .tolerance = 0.0}).correct(problem, report);
    const Trajectory graph = corrected(problem);
    EXPECT_LT(worst_difference(dual, graph), 1e-4) << seed;
    const double cost = chain_cost(problem, poses(graph));
    EXPECT_NEAR(chain_cost(problem, poses(dual)), cost, 1e-6 * cost);
  }
}

TEST(PoseGraph, StandsStillAtItsMinimum) {
  // Analytic Jacobians are right when no numeric direction lowers the cost any further.
  const Problem problem = walk(9, 20, 0.1);
  const std::vector<Pose> best = poses(corrected(problem));
  const double least = chain_cost(problem, best);
  for (std::size_t i = 1; i < best.size(); ++i) {
    for (int d = 0; d < 6; ++d) {
      Twist step = Twist::Zero();
      step[d] = 1e-5;
      std::vector<Pose> up = best;
      std::vector<Pose> down = best;
      up[i] = best[i] * exp_se3(step);
      down[i] = best[i] * exp_se3(-step);
      const double slope = (chain_cost(problem, up) - chain_cost(problem, down)) / 2e-5;
      EXPECT_NEAR(slope, 0.0, 1e-4) << i << " " << d;
      EXPECT_GT(chain_cost(problem, up), least);
    }
  }
}

TEST(PoseGraph, StartDoesNotMatterNearTheMinimum) {
  const Problem problem = walk(4, 60, 0.02);
  EXPECT_LT(worst_difference(corrected(problem),
                             corrected(problem, {.start = PoseGraphOptimizer::Start::odometry})),
            1e-6);
}

/// Twelve true loops whose errors obey their information, and every third one false besides.
Problem partly_false(std::uint64_t seed) {
  Problem problem = walk(seed, 120, 0.0);
  std::mt19937_64 random(seed + 100);
  const Trajectory truth = problem.keyframes;
  problem.closures.clear();
  const auto add = [&](std::size_t from, std::size_t to, const Twist& error) {
    const Pose exact = truth[from].world_from_body.inverse() * truth[to].world_from_body;
    problem.closures.push_back({from, to, normalized(exact * exp_se3(error)), Matrix6::Identity()});
    problem.closures.back().information *= 1e4;
  };
  for (std::size_t k = 0; k < 12; ++k) {
    add(k, 100 + k, random_twist(random, 0.01, 0.01));
    if (k % 3 == 0) add(k, 101 + k, random_twist(random, 5.0, 1.0));
  }
  std::sort(problem.closures.begin(), problem.closures.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.to, a.from) < std::tie(b.to, b.from);
  });
  for (Edge& edge : problem.odometry) {
    edge.from_from_to = normalized(edge.from_from_to * exp_se3(random_twist(random, 0.005, 0.002)));
    edge.information = Matrix6::Identity() * 1e5;
  }
  for (std::size_t i = 0; i + 1 < truth.size(); ++i) {
    problem.keyframes[i + 1].world_from_body =
        problem.keyframes[i].world_from_body * problem.odometry[i].from_from_to;
  }
  return problem;
}

TEST(PoseGraph, GraduatedNonConvexityLetsGoOfFalseClosures) {
  for (const auto kind : {PoseGraphOptimizer::Gnc::tls, PoseGraphOptimizer::Gnc::gm}) {
    const Problem problem = partly_false(7);
    const Trajectory truth = walk(7, 120, 0.0).keyframes;
    Report report;
    const Trajectory robust = PoseGraphOptimizer({.gnc = kind}).correct(problem, report);
    const auto kept = std::ranges::find(report.counts, "closures_kept", &Count::name);
    EXPECT_EQ(kept->value, 12.0) << to_text(kind);
    const double plain = (corrected(problem).back().world_from_body.translation -
                          truth.back().world_from_body.translation)
                             .norm();
    const double error =
        (robust.back().world_from_body.translation - truth.back().world_from_body.translation)
            .norm();
    EXPECT_LT(error, 0.2 * plain) << to_text(kind);
  }
}

TEST(PoseGraph, KeepsEveryClosureWhenAllAreTrue) {
  Problem problem = partly_false(3);
  std::erase_if(problem.closures, [](const Edge& e) { return e.to - e.from == 101; });
  Report report;
  const Trajectory gnc =
      PoseGraphOptimizer({.gnc = PoseGraphOptimizer::Gnc::tls}).correct(problem, report);
  EXPECT_LT(worst_difference(gnc, corrected(problem)), 1e-9);
}

TEST(PoseGraph, BoundedLossesPullLess) {
  Problem problem = walk(2, 30, 0.01);
  problem.closures.resize(1);
  Pose& measured = problem.closures[0].from_from_to;
  measured.translation += Vector3(50.0, 0.0, 0.0);
  const auto moved = [&](Loss loss) {
    const Trajectory out = corrected(problem, {.loss = loss});
    const std::size_t to = problem.closures[0].to;
    return (out[to].world_from_body.translation - problem.keyframes[to].world_from_body.translation)
        .norm();
  };
  const double plain = moved(Loss::none);
  EXPECT_GT(plain, 10.0);
  EXPECT_LT(moved(Loss::huber), 0.2 * plain);
  EXPECT_LT(moved(Loss::cauchy), moved(Loss::huber));
  EXPECT_LT(moved(Loss::dcs), 0.01 * plain);
  EXPECT_LT(moved(Loss::switchable), 0.01 * plain);
}

TEST(PoseGraph, RefusesInformationThatIsNone) {
  Problem problem = walk(2, 10, 0.01);
  problem.odometry[3].information.setZero();
  EXPECT_THROW(corrected(problem), std::runtime_error);
}

}  // namespace
}  // namespace loopbench
