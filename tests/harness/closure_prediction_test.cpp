/// The metric `closure_prediction` of methods that run again, against the closed form.
#include <gtest/gtest.h>

#include "harness/config/read_sweep.hpp"
#include "harness/run/run_cell.hpp"
#include "methods/correctors/closure_ledger.hpp"
#include "tests/support/rounds.hpp"

namespace loopbench::closure_prediction_test {

using namespace harness;

namespace {

/// The score of a method on `problem`, which has no reference.
metrics::Statistics predicted(const Problem& problem, const std::string& method) {
  const Catalogue known = catalogue({});
  const Sweep sweep = parse_sweep("datasets: [{dataset: simulated, path: room}]\nmethods: [" +
                                      method + "]\nmetrics: [closure_prediction]\n",
                                  "c.yaml",
                                  known);
  return run_cell({}, sweep, {"rounds", problem, {}, {}}, known).scores.at(0).score.statistics;
}

TEST(ClosurePrediction, IsOneForRawAndTheClosedFormForDual) {
  const Problem problem = test::rounds(3, 1e-7);  // linear to the tolerance
  EXPECT_EQ(predicted(problem, "raw").rmse, 1.0);
  const metrics::Statistics dual = predicted(problem, "{method: dual, tolerance: 1.0e-14}");
  EXPECT_NEAR(dual.rmse / methods::closure_ledger(problem).ratio, 1.0, 1e-6);
  EXPECT_EQ(dual.count, 5u);
}

TEST(ClosurePrediction, OrdersMethodsAsTheTruthDoes) {
  Problem problem = test::rounds(1);
  EXPECT_LT(predicted(problem, "dual").rmse, 0.9);
  problem.closures[2].from_from_to.translation += Vector3(8.0, 0.0, 0.0);
  const double dual = predicted(problem, "dual").rmse;
  EXPECT_GT(dual, 2.0);
  EXPECT_LT(predicted(problem, "pose_graph_pcm").rmse, 0.6 * dual);
}

}  // namespace
}  // namespace loopbench::closure_prediction_test
