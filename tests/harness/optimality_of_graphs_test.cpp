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

TEST(OptimalityOfGraphs, PublishedOptimaAreProved) {
  // Printed by Rosen et al., SE-Sync, IJRR 2019, to four digits.
  for (const auto& [file, optimum] :
       {std::pair{"intel.g2o", 52.35}, std::pair{"M3500_with_vertices.g2o", 193.9}}) {
    try {
      const Certificate proof = solved(file, PoseGraphOptimizer::Start::chordal);
      EXPECT_NEAR(proof.minimum, optimum, 5e-4 * optimum) << file;
      EXPECT_GT(proof.lower_bound, (1.0 - 1e-6) * proof.minimum) << file;
    } catch (const DataMissing& missing) {
      GTEST_SKIP() << missing.what();
    }
  }
}

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
