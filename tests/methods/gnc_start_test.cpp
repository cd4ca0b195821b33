// Initial values of graduated non-convexity, its report, and closures stated as exact.
#include <gtest/gtest.h>

#include <cstdlib>

#include "datasets/pose_graph_dataset.hpp"
#include "methods/correctors/plausibility.hpp"
#include "methods/find_method.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/simulated_drive.hpp"

namespace loopbench::gnc_start_test {

using namespace methods;

namespace {

struct Corrected {
  Trajectory keyframes;
  Report report;

  double count(const std::string& name) const { return test::count(report, name); }
};

/// Corrects the problem by a method of the catalogue with default options.
Corrected corrected(const std::string& name, const Problem& problem) {
  const Stage stage = find_method(name).make({});
  Corrected out;
  out.keyframes = std::get<std::unique_ptr<const Corrector>>(stage)->correct(problem, out.report);
  return out;
}

Sequence drive(double false_share) { return test::simulated_drive({.false_share = false_share}); }

double rmse(const Trajectory& keyframes, const Sequence& sequence) {
  // Not aligned: the first keyframe is fixed at its true position.
  return test::rmse(keyframes, test::at_stamps_of(keyframes, sequence.reference));
}

TEST(GncStart, KeepsTrueClosuresWhenKeyframesLieInAnotherMinimum) {
  const char* root = std::getenv("LOOPBENCH_DATA");
  if (root == nullptr) GTEST_SKIP() << "LOOPBENCH_DATA is not set";
  try {
    PoseGraphOptions options;
    options.path = "pose_graphs/INTEL_1228_with_vertices.g2o";
    const Problem intel = load_pose_graph(options, {{root}}).problem;
    options.path = "pose_graphs/MIT.g2o";
    const Problem mit = load_pose_graph(options, {{root}}).problem;
    constexpr const char* kName = "pose_graph_gnc_tls";
    EXPECT_GE(corrected(kName, intel).count("closures_kept"), 250.0);  // of 256
    EXPECT_LT(corrected(kName, mit).count("chi2"), 40.0);              // from all closures: 400
  } catch (const DataMissing& missing) {
    GTEST_SKIP() << missing.what();
  }
}

TEST(GncStart, ReportsKeptClosuresAndWarnsWhenTheyAreFew) {
  const Corrected most = corrected("pose_graph_gnc_tls", drive(0.0).problem);
  EXPECT_GE(most.count("closures_kept"), 18.0);
  EXPECT_TRUE(most.report.notes.empty());
  const Problem mixed = drive(0.7).problem;
  const Corrected few = corrected("pose_graph_gnc_tls", mixed);
  EXPECT_LE(few.count("closures_kept"), 20.0);
  ASSERT_EQ(few.report.notes.size(), 1u);
  EXPECT_NE(few.report.notes[0].find("of " + std::to_string(mixed.closures.size()) + " closures"),
            std::string::npos)
      << few.report.notes[0];
}

TEST(GncStart, ExactClosuresAreSolvedAsWellAsPreciseOnes) {
  Sequence sequence = drive(0.0);
  for (Edge& closure : sequence.problem.closures) closure.information.setIdentity();
  const auto with_information = [&](double information) {
    Problem out = sequence.problem;
    for (Edge& closure : out.closures) closure.information *= information;
    return out;
  };
  const double precise =
      rmse(corrected("pose_graph_gnc_tls", with_information(1e8)).keyframes, sequence);
  for (const char* name : {"pose_graph_gnc_tls", "pose_graph"}) {
    const double exact = rmse(corrected(name, with_information(1e24)).keyframes, sequence);
    EXPECT_LT(exact, 1.1 * precise) << name;
  }
}

TEST(GncStart, StiffnessIsBoundedRowByRow) {
  Problem problem = drive(0.0).problem;
  EXPECT_FALSE(is_stiff(problem));
  Matrix6 information = 1e20 * Matrix6::Identity();
  information(0, 1) = information(1, 0) = 5e19;
  problem.closures[0].information = information;
  ASSERT_TRUE(is_stiff(problem));
  const Problem bounded = with_bounded_stiffness(problem);
  EXPECT_FALSE(is_stiff(bounded));
  const Matrix6& found = bounded.closures[0].information;
  EXPECT_NEAR(found(0, 1), 0.5 * found(0, 0), 1e-6 * found(0, 0));  // correlation kept
  EXPECT_EQ(bounded.closures[1].information, problem.closures[1].information);
}

TEST(DualPcm, TwentyPercentFalseClosuresAddAtMostTenPercentError) {
  const Sequence clean = drive(0.0);
  const Sequence mixed = drive(0.2);
  const double without = rmse(corrected("dual", clean.problem).keyframes, clean);
  EXPECT_GT(rmse(corrected("dual", mixed.problem).keyframes, mixed), 3.0 * without);
  EXPECT_LT(rmse(corrected("dual_pcm", mixed.problem).keyframes, mixed), 1.1 * without);
}

}  // namespace
}  // namespace loopbench::gnc_start_test
