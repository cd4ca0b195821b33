/// The metric `closure_prediction` of methods that run again, against the closed form; the ledger
/// that a report shows.
#include <gtest/gtest.h>

#include <sstream>

#include "harness/sweep/config/read_sweep.hpp"
#include "harness/sweep/model/loops.hpp"
#include "harness/sweep/run/run_cell.hpp"
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
  EXPECT_NEAR(
      dual.rmse / methods::closure_ledger(problem).ratio, 1.0, 3e-6);  // rounding of 1e-13 m
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

TEST(StoredLedger, HasTheSentenceAndARowForEachClosure) {
  Problem problem = test::rounds(1);
  problem.closures[2].from_from_to.translation += Vector3(8.0, 0.0, 0.0);
  std::istringstream lines(stored_ledger(problem));
  std::string sentence, header, first;
  std::getline(lines, sentence);
  std::getline(lines, header);
  std::getline(lines, first);
  const std::string name = closure_name(problem, 2);
  EXPECT_TRUE(
      sentence.starts_with("1 of 5 closures disagrees with the 4 that agree: " + name + " ("))
      << sentence;
  EXPECT_TRUE(header.starts_with("from,to,place,loop_m,odometry_m,")) << header;
  EXPECT_TRUE(first.ends_with(",2,disagrees,1,1")) << first;
  EXPECT_EQ(std::count(std::istreambuf_iterator<char>(lines), {}, '\n'), 4);  // of five closures
}

TEST(StoredLedger, StatesWhyThereIsNone) {
  Problem problem = test::rounds(1);
  problem.closures[0].scale = 1.1;
  EXPECT_EQ(stored_ledger(problem), "edges change the scale, which the ledger does not estimate");
  problem.closures.resize(201, problem.closures[1]);
  EXPECT_EQ(stored_ledger(problem),
            "Not computed for more than 200 closures (here 201): see loopbench loops");
  problem.closures.resize(21);
  problem.keyframes.resize(100'000);
  EXPECT_EQ(stored_ledger(problem),
            "Not computed for 21 closures of 100000 keyframes: see loopbench loops");
  problem.closures.clear();
  EXPECT_EQ(stored_ledger(problem), "");
}

TEST(PlainNumber, HasNoExponent) {
  EXPECT_EQ(plain_number(2466.1), "2466");
  EXPECT_EQ(plain_number(12.345), "12.3");
  EXPECT_EQ(plain_number(1.2345), "1.23");
  EXPECT_EQ(plain_number(1e-6), "0.000");
}

}  // namespace
}  // namespace loopbench::closure_prediction_test
