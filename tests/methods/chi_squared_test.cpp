// chi2 per degree of freedom, as counted by dual and pose_graph, which judge no closures by it.
#include "methods/correctors/chi_squared.hpp"

#include <gtest/gtest.h>

#include "methods/correctors/dual.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/simulated_drive.hpp"

namespace loopbench::test::chi_squared_test {
namespace {

Problem simulated(SimulatedPath path, bool planar, std::int64_t seed) {
  return test::simulated_drive({.path = path, .closures = 10, .seed = seed, .planar = planar})
      .problem;
}

/// The problem with all covariances multiplied by `factor`.
Problem with_covariances(Problem problem, double factor) {
  for (std::vector<Edge>* edges : {&problem.odometry, &problem.closures}) {
    for (Edge& edge : *edges) edge.information /= factor;
  }
  return problem;
}

template <class Method>
Report reported(const Problem& problem) {
  Report out;
  Method({}).correct(problem, out);
  return out;
}

TEST(ChiSquared, SimulatedDatasetsStateTheirTrueNoise) {
  for (const auto& [path, planar] : {std::pair{SimulatedPath::driving, true},
                                     std::pair{SimulatedPath::driving, false},
                                     std::pair{SimulatedPath::room, false}}) {
    double mean = 0.0;
    constexpr int kSeeds = 8;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      mean += count(reported<Dual>(simulated(path, planar, seed)), "chi2_per_dof") / kSeeds;
    }
    EXPECT_NEAR(mean, 1.0, 0.25) << to_text(path) << (planar ? ", planar" : "");
  }
}

TEST(ChiSquared, FollowsTheStatedCovariancesWithoutANote) {
  const Problem problem = simulated(SimulatedPath::room, false, 2);
  const double right = count(reported<PoseGraphOptimizer>(problem), "chi2_per_dof");
  for (const double factor : {1e-2, 1e2}) {
    const Problem wrong = with_covariances(problem, factor);
    for (const Report& report : {reported<Dual>(wrong), reported<PoseGraphOptimizer>(wrong)}) {
      EXPECT_NEAR(count(report, "chi2_per_dof") * factor, right, 1e-3 * right);
      EXPECT_TRUE(report.notes.empty());
    }
    const Problem anchored = with_anchors(wrong, Vector3::Zero());
    EXPECT_TRUE(reported<PoseGraphOptimizer>(anchored).notes.empty());
  }
}

TEST(ChiSquared, IsUnlikelyAboveItsQuantile) {
  // 99.95 % quantiles of tables: 17.73 with 3 degrees of freedom, 24.10 with 6, 153.17 with 100
  for (const auto& [dof, quantile] : {std::pair{3UL, 17.73}, {6UL, 24.10}, {100UL, 153.17}}) {
    EXPECT_FALSE(is_unlikely(0.97 * quantile, dof)) << dof;
    EXPECT_TRUE(is_unlikely(1.03 * quantile, dof)) << dof;
  }
  EXPECT_FALSE(is_unlikely(1.0, 0));
}

TEST(ChiSquared, IsNotCountedWithoutDegreesOfFreedom) {
  Report report;
  count_chi2_per_dof(0.5, 0, report);
  EXPECT_TRUE(report.counts.empty());
  count_chi2_per_dof(0.5, 6, report);
  EXPECT_EQ(count(report, "chi2_per_dof"), 0.5 / 6.0);
}

}  // namespace
}  // namespace loopbench::test::chi_squared_test
