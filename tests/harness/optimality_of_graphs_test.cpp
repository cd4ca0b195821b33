// Certificates of public pose graphs, if LOOPBENCH_DATA contains them.
#include <gtest/gtest.h>

#include <cstdlib>

#include "datasets/pose_graph_dataset.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "metrics/correction/optimality.hpp"

namespace loopbench::optimality_of_graphs_test {

namespace {

using methods::PoseGraphOptimizer;
using metrics::Certificate;

/// The certificate of pose_graph's result from a start. Throws DataMissing.
Certificate solved(const std::string& file, PoseGraphOptimizer::Start start) {
  const char* root = std::getenv("LOOPBENCH_DATA");
  if (root == nullptr) throw DataMissing("LOOPBENCH_DATA is not set");
  PoseGraphOptions options;
  options.path = "pose_graphs/" + file;
  const Problem problem = load_pose_graph(options, {{root}}).problem;
  methods::Report report;
  return metrics::certificate(problem,
                              PoseGraphOptimizer({.start = start}).correct(problem, report));
}

struct Published {
  std::string file;
  double optimum;  ///< printed by Rosen et al., SE-Sync, IJRR 2019, to four digits
};

class PublishedOptimum : public ::testing::TestWithParam<Published> {};

TEST_P(PublishedOptimum, IsProved) {
  try {
    const Certificate proof = solved(GetParam().file, PoseGraphOptimizer::Start::chordal);
    EXPECT_NEAR(proof.minimum, GetParam().optimum, 5e-4 * GetParam().optimum);
    EXPECT_GT(proof.lower_bound, (1.0 - 1e-6) * proof.minimum);
  } catch (const DataMissing& missing) {
    GTEST_SKIP() << missing.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Graphs,
                         PublishedOptimum,
                         ::testing::Values(Published{"intel.g2o", 52.35},
                                           Published{"M3500_with_vertices.g2o", 193.9}),
                         [](const auto& graph) { return graph.param.file.substr(0, 5); });

TEST(OptimalityOfGraphs, WrongMinimumOfMitIsNotProved) {
  try {
    const Certificate wrong = solved("MIT.g2o", PoseGraphOptimizer::Start::keyframes);
    const Certificate best = solved("MIT.g2o", PoseGraphOptimizer::Start::chordal);
    EXPECT_GT(wrong.minimum, 1000.0);
    EXPECT_EQ(wrong.lower_bound, 0.0);
    EXPECT_LT(best.minimum, 62.0);
    EXPECT_GT(best.lower_bound, (1.0 - 1e-6) * best.minimum);
  } catch (const DataMissing& missing) {
    GTEST_SKIP() << missing.what();
  }
}

}  // namespace
}  // namespace loopbench::optimality_of_graphs_test
