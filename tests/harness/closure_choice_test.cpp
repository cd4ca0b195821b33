/// The metrics `closures_kept_false` and `closures_dropped_true` in a sweep: values of methods that
/// state which closures they reject, reasons for all others, and no label for the methods.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/sweep/config/read_sweep.hpp"
#include "harness/sweep/run/run_cell.hpp"
#include "tests/support/rounds.hpp"

namespace loopbench::closure_choice_sweep_test {

using namespace harness;
using testing::HasSubstr;

namespace {

/// Both scores of a method on five closures of a round without a reference, one of them false.
std::vector<ScoreResult> scores(const std::string& method,
                                std::optional<std::vector<std::size_t>> false_closures) {
  const Catalogue known = catalogue({});
  const Sweep sweep =
      parse_sweep("datasets: [{dataset: simulated, path: room}]\nmethods: [" + method +
                      "]\nmetrics: [closures_kept_false, closures_dropped_true]\n",
                  "c.yaml",
                  known);
  Problem problem = test::rounds(1);
  problem.closures[2].from_from_to.translation += Vector3(8.0, 0.0, 0.0);
  return run_cell({}, sweep, {"rounds", problem, {}, {}, {}, std::move(false_closures)}, known)
      .scores;
}

TEST(ClosureChoice, OfMethodsThatChooseIsTheirShareOfMistakes) {
  for (const char* method : {"pose_graph_pcm", "pose_graph_gnc_tls", "consensus", "dual_pcm"}) {
    const auto right = scores(method, {{2}});
    EXPECT_EQ(right.at(0).score.statistics.mean, 0.0) << method << ": " << right[0].why;
    EXPECT_EQ(right.at(1).score.statistics.mean, 0.0) << method << ": " << right[1].why;
    const auto other = scores(method, {{0, 2}});  // another label changes the score only
    EXPECT_DOUBLE_EQ(other.at(0).score.statistics.mean, 50.0) << method;
    EXPECT_EQ(other.at(1).score.statistics.mean, 0.0) << method;
  }
}

TEST(ClosureChoice, IsAbsentWithAReasonOtherwise) {
  for (const char* method : {"raw", "dual", "pose_graph", "pose_graph_huber", "uniform"}) {
    for (const ScoreResult& each : scores(method, {{2}})) {
      EXPECT_EQ(each.status, Status::declined) << method;
      EXPECT_EQ(each.why, "the method does not state which closures it rejects") << method;
    }
  }
  const auto unknown = scores("pose_graph_pcm", std::nullopt);
  EXPECT_EQ(unknown.at(0).status, Status::declined);
  EXPECT_THAT(unknown.at(0).why, HasSubstr("which closures are false is not known"));
}

}  // namespace
}  // namespace loopbench::closure_choice_sweep_test
