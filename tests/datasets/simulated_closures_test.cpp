#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <set>

#include "datasets/simulated/closures.hpp"
#include "datasets/simulated/path.hpp"
#include "datasets/simulated/simulated.hpp"

namespace loopbench::simulated_closures_test {
namespace {

constexpr double kPi = std::numbers::pi;

Twist error_of(const Edge& edge, const Problem& problem, const Path& path) {
  const Pose a = path.at(problem.keyframes[edge.from].stamp);
  const Pose b = path.at(problem.keyframes[edge.to].stamp);
  return log_se3(edge.from_from_to.inverse() * (a.inverse() * b));
}

TEST(SimulatedClosures, JoinSeparateVisitsOfOnePlace) {
  for (const SimulatedPath which :
       {SimulatedPath::room, SimulatedPath::office, SimulatedPath::driving}) {
    SimulatedOptions options;
    options.path = which;
    const Problem problem = load_simulated(options).problem;
    const Path path = path_of(which);
    EXPECT_GE(problem.closures.size(), 2U) << to_text(which);
    EXPECT_LE(problem.closures.size(), 10U);
    EXPECT_GT(problem.closures.back().to, problem.keyframes.size() - 3) << "the lap closes";
    for (const Edge& edge : problem.closures) {
      const double begin = problem.keyframes[edge.from].stamp;
      const double end = problem.keyframes[edge.to].stamp;
      EXPECT_GE(end - begin, 10.0);
      EXPECT_TRUE(is_close(path.at(begin), path.at(end), path.closure_radius, kPi / 6.0));
    }
  }
}

TEST(SimulatedClosures, AreSpreadOverAllRevisits) {
  SimulatedOptions options;
  options.path = SimulatedPath::driving;
  options.closures.max = 1000;
  const Problem all = load_simulated(options).problem;
  options.closures.max = 4;
  const Problem few = load_simulated(options).problem;
  ASSERT_EQ(few.closures.size(), 4U);
  EXPECT_GT(all.closures.size(), 40U);
  EXPECT_EQ(few.closures.back().to, all.closures.back().to);
  EXPECT_EQ(few.closures.front().to, all.closures[all.closures.size() / 4 - 1].to);
  options.closures.max = 0;
  const Sequence none = load_simulated(options);
  EXPECT_TRUE(none.problem.closures.empty());
  EXPECT_EQ(none.provenance.closures, "none");
}

TEST(SimulatedClosures, ErrorsAreAsLargeAsTheInformationSays) {
  SimulatedOptions options;
  options.path = SimulatedPath::driving;
  options.closures.max = 100;
  options.closures.sigma_t = 0.3;
  options.closures.sigma_r = 0.01;
  options.reference_rate = 1.0;
  const Path path = path_of(options.path);
  double edges = 0.0, chi_square = 0.0;
  for (options.seed = 0; options.seed < 120; ++options.seed) {
    const Problem problem = load_simulated(options).problem;
    for (const Edge& edge : problem.closures) {
      const Twist e = error_of(edge, problem, path);
      edges += 1.0;
      chi_square += e.dot(edge.information * e);
    }
  }
  EXPECT_NEAR(chi_square / edges, 6.0, 4.0 * std::sqrt(12.0 / edges));
  EXPECT_GT(edges, 4000.0);
}

TEST(SimulatedClosures, FalseOnesAreCountedAndGrosslyWrong) {
  SimulatedOptions options;
  options.path = SimulatedPath::driving;
  options.closures.false_share = 0.5;
  const Problem problem = load_simulated(options).problem;
  EXPECT_EQ(problem.closures.size(), 20U);
  const Path path = path_of(options.path);
  int wrong = 0;
  for (const Edge& edge : problem.closures) {
    const Twist e = error_of(edge, problem, path);
    if (e.dot(edge.information * e) > 60.0) ++wrong;
  }
  EXPECT_EQ(wrong, 10);
  options.closures.false_share = 0.2;  // 10 true and 2.5 false closures, rounded to 12 or 13
  const std::size_t some = load_simulated(options).problem.closures.size();
  EXPECT_EQ(some, 13U);
}

TEST(SimulatedClosures, FalseOnesLeaveTheTrueOnesAsTheyWereInOneStream) {
  SimulatedOptions options;
  options.stream = "shared";  // otherwise the noise would depend on the share
  const Problem before = load_simulated(options).problem;
  options.closures.false_share = 0.5;
  const Problem after = load_simulated(options).problem;
  for (const Edge& edge : before.closures) {
    EXPECT_TRUE(std::any_of(after.closures.begin(), after.closures.end(), [&](const Edge& other) {
      return other.from == edge.from && other.to == edge.to &&
             other.from_from_to.translation == edge.from_from_to.translation;
    }));
  }
  EXPECT_EQ(before.keyframes.back().world_from_body.translation,
            after.keyframes.back().world_from_body.translation);
}

TEST(SimulatedClosures, FalseOnesAreRefusedWhereEveryPlaceIsTheSame) {
  SimulatedOptions options;
  options.path = SimulatedPath::still;
  options.closures.false_share = 0.5;
  try {
    load_simulated(options);
    FAIL();
  } catch (const OptionError& error) {
    EXPECT_EQ(error.option(), "closures.false_share");
  }
}

}  // namespace
}  // namespace loopbench::simulated_closures_test
