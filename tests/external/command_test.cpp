// Arguments and results of programs as methods and metrics.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/core/error.hpp"
#include "datasets/core/params.hpp"
#include "harness/sweep/catalogue/arguments.hpp"
#include "harness/sweep/catalogue/command_metric.hpp"
#include "harness/sweep/catalogue/exchange.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::command_test {

using namespace harness;

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Arguments, AreSplitAsByAShellWithoutExpansions) {
  EXPECT_THAT(split_arguments("run", R"(a  'b "c' "d 'e" f\ g "" $HOME *)"),
              ElementsAre("a", "b \"c", "d 'e", "f g", "", "$HOME", "*"));
  EXPECT_THROW(split_arguments("run", "a 'b"), OptionError);
  EXPECT_THROW(split_arguments("run", "  "), OptionError);
  EXPECT_THAT(with_values({"{problem}/x", "{other}", "{", "a{result}"},
                          {{"problem", "/p q"}, {"result", "{problem}"}}),
              ElementsAre("/p q/x", "{other}", "{", "a{problem}"));
}

TEST(ResultMetadata, IsCheckedWhenRead) {
  const ResultMetadata metadata =
      parse_metadata(R"({"seconds": 0.5, "iterations": 7, "counts": {"a": 1}, "notes": ["x"]})");
  EXPECT_EQ(metadata.seconds, 0.5);
  EXPECT_EQ(metadata.report.counts.size(), 2u);
  EXPECT_THAT(metadata.report.notes, ElementsAre("x"));
  EXPECT_THROW(parse_metadata("{"), std::runtime_error);
  EXPECT_THROW(parse_metadata("[]"), std::runtime_error);
  EXPECT_THROW(parse_metadata(R"({"iterations": "many"})"), std::runtime_error);
}

TEST(MetricResult, ItsMistakesAreNamed) {
  const auto why = [](const std::string& text) {
    return refusal_of([&] { parse_scores(text, 0, 2); });
  };
  EXPECT_EQ(why(R"({})"), "result: has no scores");
  EXPECT_EQ(why(R"({"scores": [{"name": "a", "unit": "m", "value": 1, "beter": "higher"}]})"),
            "result: a score: found key 'beter', expected name, axis, unit, value, values, better, "
            "target");
  EXPECT_EQ(why(R"({"scores": [{"name": "a", "value": 1}]})"), "result: a: has no unit");
  const std::string both = R"({"name": "a", "unit": "m", "value": 1, "values": [1]})";
  EXPECT_EQ(why(R"({"scores": [)" + both + "]}"), "result: a: expected either value or values");
  EXPECT_THAT(why(R"({"secnds": 1})"),
              HasSubstr("result.json: found key 'secnds', expected status"));
}

TEST(MetricResult, AValueForEachPairIsKept) {
  const auto kept = [](std::size_t pairs) {
    return parse_scores(R"({"scores": [{"name": "a", "unit": "m", "values": [3, 4]}]})", 0, pairs)
        .front()
        .per_pose;
  };
  EXPECT_THAT(kept(2), ElementsAre(3.0, 4.0));
  EXPECT_THAT(kept(3), ElementsAre());
}

TEST(Costs, CannotBeStatedByMethodsThatAreNoProgramsEither) {
  methods::Report report;
  report.counts = {{kProgramTime, 1e-6}, {kProgramMemory, -1.0}, {"mine", 7.0}};
  report.phases = {{kExchangePhase, 1e6}, {kWallPhase, 1e6}, {"solve", 0.1}};
  settle_costs(report);
  ASSERT_EQ(report.counts.size(), 1u);
  EXPECT_EQ(report.counts[0].name, "mine");
  ASSERT_EQ(report.phases.size(), 1u);
  EXPECT_EQ(report.phases[0].name, "solve");
  ASSERT_EQ(report.notes.size(), 4u);
  for (const std::string& note : report.notes) EXPECT_THAT(note, HasSubstr("is measured by"));
}

}  // namespace
}  // namespace loopbench::command_test
