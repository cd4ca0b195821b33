// Public pose graphs and chains with known optima, if LOOPBENCH_DATA contains them.
#include <gtest/gtest.h>

#include <cstdlib>

#include "datasets/pose_graph_dataset.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "tests/support/corrected.hpp"

namespace loopbench::test::known_optima_test {
namespace {

/// A problem of the data folder, or the reason why it is missing.
struct Loaded {
  std::optional<Problem> problem;
  std::string why = "LOOPBENCH_DATA is not set";
};

Loaded loaded(const std::string& path) {
  Loaded out;
  const char* root = std::getenv("LOOPBENCH_DATA");
  if (root == nullptr) return out;
  PoseGraphOptions options;
  options.path = path;
  try {
    out.problem = load_pose_graph(options, {{root}}).problem;
  } catch (const DataMissing& missing) {
    out.why = missing.what();
  }
  return out;
}

struct Optimum {
  std::string file;
  double chi2;  ///< not halved, information as read by g2o
};

class KnownOptimum : public ::testing::TestWithParam<Optimum> {};

TEST_P(KnownOptimum, IsReached) {
  const auto [problem, why] = loaded("pose_graphs/" + GetParam().file);
  if (!problem) GTEST_SKIP() << why;
  Report report;
  PoseGraphOptimizer({.start = PoseGraphOptimizer::Start::chordal}).correct(*problem, report);
  const double chi2 = test::count(report, "chi2");
  EXPECT_LT(chi2, GetParam().chi2 * (1.0 + 1e-4));
}

// Source of the values: results/methods/pose_graphs.md.
INSTANTIATE_TEST_SUITE_P(Graphs,
                         KnownOptimum,
                         ::testing::Values(Optimum{"intel.g2o", 45.0043},
                                           Optimum{"M3500_with_vertices.g2o", 137.915},
                                           Optimum{"parking-garage.g2o", 1.23870},
                                           Optimum{"sphere2500.g2o", 727.286}),
                         [](const auto& graph) {
                           std::string name = graph.param.file.substr(0, 4);
                           std::erase(name, '-');
                           return name;
                         });

TEST(KnownOptimum, LoopEquationsSaveIterationsOnKitti00) {
  const auto [problem, why] = loaded("cop_slam/KITTI_00_vo.g2o");
  if (!problem) GTEST_SKIP() << why;
  using Start = PoseGraphOptimizer::Start;
  Report keyframes, chordal;
  const Trajectory slow =
      PoseGraphOptimizer({.start = Start::keyframes}).correct(*problem, keyframes);
  const Trajectory fast = PoseGraphOptimizer({.start = Start::chordal}).correct(*problem, chordal);
  EXPECT_LT(test::count(chordal, "iterations"), 0.2 * test::count(keyframes, "iterations"));
  EXPECT_NEAR(test::count(chordal, "chi2"), test::count(keyframes, "chi2"), 1e-6);
  EXPECT_LT(test::largest_distance(slow, fast), 1e-2);
}

TEST(KnownOptimum, DualFindsTheLowerMinimumOfMit) {
  const auto [problem, why] = loaded("pose_graphs/MIT.g2o");
  if (!problem) GTEST_SKIP() << why;
  const auto chi2 = [](const Report& report) { return test::count(report, "chi2"); };
  Report from_keyframes, dual, graph;
  Dual({.start = Dual::Start::keyframes}).correct(*problem, from_keyframes);
  Dual({}).correct(*problem, dual);
  PoseGraphOptimizer({.start = PoseGraphOptimizer::Start::chordal}).correct(*problem, graph);
  EXPECT_GT(chi2(from_keyframes), 700.0);
  EXPECT_NEAR(chi2(graph), 41.2, 0.1);
  EXPECT_NEAR(chi2(dual), chi2(graph), 1e-3 * chi2(graph));
  ASSERT_FALSE(dual.notes.empty());
  EXPECT_TRUE(dual.notes[0].starts_with("two minima")) << dual.notes[0];
}

}  // namespace
}  // namespace loopbench::test::known_optima_test
