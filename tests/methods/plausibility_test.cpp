// chi2 per degree of freedom, as reported by dual and pose_graph.
#include "methods/correctors/plausibility.hpp"

#include <gtest/gtest.h>

#include "methods/correctors/dual.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/simulated_drive.hpp"

namespace loopbench::plausibility_test {

using namespace methods;

namespace {

using test::count;

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

TEST(Plausibility, SimulatedDatasetsStateTheirTrueNoise) {
  for (const auto& [path, planar] : {std::pair{SimulatedPath::driving, true},
                                     std::pair{SimulatedPath::driving, false},
                                     std::pair{SimulatedPath::room, false}}) {
    double mean = 0.0;
    constexpr int kSeeds = 8;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      const Report report = reported<Dual>(simulated(path, planar, seed));
      mean += count(report, "chi2_per_dof") / kSeeds;
      EXPECT_TRUE(report.notes.empty()) << report.notes.front();
    }
    EXPECT_NEAR(mean, 1.0, 0.25) << to_text(path) << (planar ? ", planar" : "");
  }
}

TEST(Plausibility, DualAndPoseGraphReportTheSameChi2) {
  for (const bool planar : {true, false}) {
    const Problem problem = simulated(SimulatedPath::driving, planar, 3);
    EXPECT_NEAR(count(reported<Dual>(problem), "chi2_per_dof"),
                count(reported<PoseGraphOptimizer>(problem), "chi2_per_dof"),
                1e-6);
  }
}

TEST(Plausibility, ImplausibleCovariancesAreReported) {
  const Problem problem = simulated(SimulatedPath::room, false, 2);
  for (const double factor : {1e-2, 1e2}) {
    const Problem wrong = with_covariances(problem, factor);
    for (const Report& report : {reported<Dual>(wrong), reported<PoseGraphOptimizer>(wrong)}) {
      ASSERT_EQ(report.notes.size(), 1u) << factor;
      EXPECT_NE(report.notes[0].find(factor < 1.0 ? "too small" : "too large"), std::string::npos)
          << report.notes[0];
    }
  }
}

TEST(Plausibility, FewDegreesOfFreedomMayBeFarFromOne) {
  Report report;
  report_chi2(0.5, 6, report);  // 0.8 % quantile of chi2 with 6 degrees of freedom
  EXPECT_TRUE(report.notes.empty());
  EXPECT_NEAR(count(report, "chi2_per_dof"), 0.5 / 6.0, 1e-15);
  report_chi2(5.0, 60, report);
  EXPECT_EQ(report.notes.size(), 1u);
}

}  // namespace
}  // namespace loopbench::plausibility_test
