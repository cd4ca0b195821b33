// chi2 per degree of freedom, as reported by dual and pose_graph; factors on the odometry's
// covariances, estimated from the loops.
#include "methods/correctors/plausibility.hpp"

#include <gtest/gtest.h>

#include "methods/correctors/dual.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "methods/correctors/variance_components.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/simulated_drive.hpp"

namespace loopbench::test::plausibility_test {
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

Sequence simulated(std::int64_t seed) {
  return simulated_drive({.closures = 10, .seed = seed, .planar = false});
}

TEST(VarianceComponents, FactorsMultiplyFullCovariances) {
  const Problem problem = walk(3, 10, 0.1);
  const Problem scaled = with_factors(problem, {4.0, 9.0});
  const Matrix6 before = problem.odometry[2].information.inverse();
  const Matrix6 after = scaled.odometry[2].information.inverse();
  EXPECT_NEAR(after(0, 1), 4.0 * before(0, 1), 1e-12);
  EXPECT_NEAR(after(0, 4), 6.0 * before(0, 4), 1e-12);
  EXPECT_NEAR(after(5, 5), 9.0 * before(5, 5), 1e-12);
}

TEST(VarianceComponents, EstimatesWrongVariancesFromTheLoops) {
  // Stated: translation 10 times too uncertain, rotation 10 times too certain. Each estimated
  // deviation is correct up to a factor of 3, and much better on average.
  double log_t = 0.0, log_r = 0.0;
  constexpr int kSeeds = 6;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Problem wrong = with_factors(simulated(seed).problem, {100.0, 0.01});
    const VarianceFactors found = variance_factors(wrong);
    const double t = 0.5 * std::log(found.translation / 0.01);
    const double r = 0.5 * std::log(found.rotation / 100.0);
    EXPECT_LT(std::abs(t), std::log(3.0)) << seed;
    EXPECT_LT(std::abs(r), std::log(3.0)) << seed;
    log_t += t / kSeeds, log_r += r / kSeeds;
  }
  EXPECT_NEAR(log_t, 0.0, std::log(1.5));
  EXPECT_NEAR(log_r, 0.0, std::log(1.5));
}

TEST(VarianceComponents, RescaledDualIsAsGoodAsWithTheTrueCovariances) {
  double right = 0.0, wrong = 0.0, with_estimated_factors = 0.0;
  for (int seed = 1; seed <= 6; ++seed) {
    const Sequence sequence = simulated(seed);
    const Problem misstated = with_factors(sequence.problem, {100.0, 0.01});
    const Trajectory best = corrected<Dual>(sequence.problem);
    const Trajectory truth = at_stamps_of(best, sequence.reference);
    right += rmse(best, truth);
    wrong += rmse(corrected<Dual>(misstated), truth);
    with_estimated_factors += rmse(corrected<Dual>(misstated, {.rescale = true}), truth);
  }
  EXPECT_GT(wrong, 1.1 * right);
  EXPECT_LT(with_estimated_factors, 1.03 * right);
}

TEST(VarianceComponents, DualAndPoseGraphAgreeWithRescale) {
  const Problem misstated = with_factors(simulated(2).problem, {100.0, 0.01});
  Report a, b;
  const Trajectory dual = corrected<Dual>(misstated, {.rescale = true}, &a);
  const Trajectory graph = corrected<PoseGraphOptimizer>(misstated, {.rescale = true}, &b);
  EXPECT_EQ(count(a, "factor_t"), count(b, "factor_t"));
  EXPECT_EQ(count(a, "factor_r"), count(b, "factor_r"));
  EXPECT_LT(rmse(dual, graph), 1e-3);
}

}  // namespace
}  // namespace loopbench::test::plausibility_test
