/// Baseline files, and reports of the gate as text.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "datasets/core/error.hpp"
#include "harness/answers/gate/gate.hpp"
#include "harness/answers/tables/gate_comment.hpp"
#include "harness/answers/tables/gate_table.hpp"
#include "tests/support/gate_snapshot.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::gate_snapshot::gate_file_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string refusal(const std::string& text) {
  return refusal_of([&] { parse_baseline(text, "b.json"); });
}

TEST(BaselineFile, ReadsBackWhatWasWritten) {
  Baseline before = baseline();
  fail(before.snapshot, 0, Status::failed);
  before.snapshot.records[2].status = Status::declined;
  before.snapshot.records[2].pairs = 0;
  rmse(before.snapshot, 1) = 1.0 / 3.0;
  before.snapshot.records[3].cell.edit().method = "a\"b\n<c>";
  const std::string text = json(before);
  const Baseline read = parse_baseline(text, "b.json");
  EXPECT_EQ(json(read), text);
  EXPECT_EQ(read.snapshot.records[1].statistics.rmse, 0.3333333);
  EXPECT_TRUE(check(before, read.snapshot).findings.empty());
  EXPECT_EQ(read.build_summary, before.build_summary);
  EXPECT_EQ(read.limits[0].relative, before.limits[0].relative);
}

TEST(BaselineFile, HasTheDigitsThatItsLimitsSee) {
  const auto written = [](double number, double relative, double absolute) {
    Baseline before = baseline();
    before.limits = {{.values = {"rmse"}, .relative = relative, .absolute = absolute}};
    rmse(before.snapshot, 0) = number;
    return parse_baseline(json(before), "b.json").snapshot.records[0].statistics.rmse;
  };
  EXPECT_EQ(written(123.456789012, 0.001, 1e-6), 123.4568);
  EXPECT_EQ(written(-1.23456789e-7, 0.001, 1e-6), -1.23e-7);
  EXPECT_EQ(written(1.23456789e-11, 0.001, 1e-6), 0.0);
  EXPECT_EQ(written(1.0 / 3.0, 0.0, 0.0), 1.0 / 3.0);
  EXPECT_TRUE(std::isnan(written(std::nan(""), 0.001, 1e-6)));
  const std::string good = json(baseline());
  const auto limited = [&](const std::string& relative) {
    std::string text = good;
    return refusal(text.replace(text.find("0.001"), 5, relative));
  };
  EXPECT_EQ(limited("1e-05"), "");
  EXPECT_EQ(limited("9e-06"),
            "b.json: limits[0]: is too tight for the numbers of the file, which are rounded to "
            "relative 1e-06, absolute 1e-09; write it again with --update (limits are kept)");
}

TEST(BaselineFile, IsRejectedAfterAChangeOfAnythingButItsLimits) {
  const std::string good = json(baseline());
  const auto without = [&](const std::string& start) {
    const std::size_t at = good.find("\n" + start);
    EXPECT_NE(at, std::string::npos) << good;
    return good.substr(0, at) + good.substr(good.find('\n', at + 1));
  };
  const std::string cell = "{\"sequence\":\"room\",\"repeat\":3,\"method\":\"raw\"";
  EXPECT_THAT(refusal(without(cell)), StartsWith("b.json: digest: found \""));
  EXPECT_THAT(refusal(without("\"digest\"")),
              StartsWith("b.json: digest: found none, expected \""));
  std::string wide = good;
  wide.replace(wide.find("0.001"), 5, "10.0");
  const Baseline read = parse_baseline(wide, "b.json");
  EXPECT_EQ(read.limits[0].relative, 10.0);
  EXPECT_EQ(check(read, sweep()).notes,
            std::vector<std::string>{
                "limit of all scores: rmse: relative 10, absolute 1e-06 (default: rmse, max: "
                "relative 0.001, absolute 1e-06)"});
}

TEST(BaselineFile, IsRefusedWithItsPlace) {
  const std::string good = json(baseline());
  EXPECT_THAT(refusal("{\n\"sweep\": \n]"), StartsWith("b.json:3: is not JSON: "));
  EXPECT_THAT(refusal(""), StartsWith("b.json:1: is not JSON: "));
  EXPECT_EQ(refusal("[]"), "b.json: baseline: expected an object");
  for (const auto& [text, format] :
       {std::pair{"{}", "null"}, std::pair{"{\"loopbench_baseline\": 9}", "9"}}) {
    EXPECT_EQ(refusal(text),
              "b.json: loopbench_baseline: found format " + std::string(format) +
                  ", expected 5; check the results, then write it again with check --update "
                  "(limits are kept)");
  }
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return refusal(text.replace(at, from.size(), to));
  };
  EXPECT_EQ(changed("\"values\":[\"rmse\"]", "\"values\":[3]"),
            "b.json: limits[0].values: expected a list of texts, found [3]");
  EXPECT_EQ(changed("\"values\":[\"rmse\"]", "\"values\":[\"rms\"]"),
            "b.json: limits[0]: no statistic is named 'rms'; did you mean 'rmse'?");
  EXPECT_EQ(changed("\"values\":[\"rmse\"]", "\"values\":[\"rmse\",\"p95\"]"),
            "b.json: cells: have no 'p95', which a limit names; write it again with --update "
            "(limits are kept)");
  EXPECT_EQ(changed("\"absolute\":", "\"absolut\":"),
            "b.json: limits[0]: no key of a limit is named 'absolut'; did you mean 'absolute'?");
  EXPECT_EQ(changed("\"relative\":0.001", "\"relative\":-1"),
            "b.json: limits[0].relative: expected a non-negative number, found -1");
}

TEST(GateText, IsMarkdownAndJUnit) {
  const GateReport report = after([](Snapshot& now) {
    rmse(now, 3) *= 2.0;
    now.records[0].cell.edit().method = "ra<w>&\"";
  });
  const std::string text = markdown(report, "quick");
  EXPECT_THAT(text, StartsWith("### quick: FAILED\n\n| cell "));
  EXPECT_THAT(text, HasSubstr("| room / raw                |"));
  EXPECT_THAT(text,
              HasSubstr("- 2 regressions, 0 improvements, 1 new cell in 16 cells and 15 scores\n"));
  const std::string xml = junit(report, "quick");
  EXPECT_THAT(xml,
              HasSubstr("<testsuite name=\"loopbench check quick\" tests=\"16\" failures=\"2\""));
  EXPECT_THAT(
      xml,
      HasSubstr("<testcase classname=\"quick\" name=\"room (repeat 1) / uniform\">\n"
                "    <failure message=\"1 regression\">ate translation 3d, dense, loopbench: "));
  Baseline odd = baseline();
  odd.snapshot.records[0].cell.edit().method = "ra<w>&\"";
  EXPECT_THAT(junit(check(odd, sweep()), "q"), HasSubstr("name=\"room / ra&lt;w&gt;&amp;&quot;\""));
  EXPECT_EQ(markdown(after([](Snapshot&) {}), "quick"),
            "### quick: passed\n\n"
            "- 0 regressions, 0 improvements, 0 new cells in 16 cells and 16 scores\n"
            "- limit of all scores: rmse: relative 0.001, absolute 1e-06 (default: rmse, max: "
            "relative 0.001, absolute 1e-06)\n");
}

/// A sweep of 64 repeats, 9 methods and 12 scores, all of which got worse, one more than the
/// others.
GateReport worse_everywhere(const std::string& suffix) {
  Baseline before;
  before.limits = {rmse_alone()};
  before.snapshot.sweep = "long" + suffix;
  for (int repeat = 0; repeat < 64; ++repeat) {
    for (int method = 0; method < 9; ++method) {
      Record record = ate(repeat, "method_" + std::to_string(method) + suffix, 1.0);
      for (int score = 0; score < 12; ++score) {
        record.kind.edit().metric = "score_" + std::to_string(score) + suffix;
        before.snapshot.records.push_back(record);
      }
    }
  }
  Snapshot now = before.snapshot;
  for (std::size_t i = 0; i < now.records.size(); ++i)
    rmse(now, i) *= i == 4000 ? 3.0 : 1.1 + 1e-5 * static_cast<double>(i);
  return check(before, now);
}

TEST(GateText, IsShortInAComment) {
  const GateReport report = worse_everywhere("");
  EXPECT_EQ(report.findings.size(), 64u * 9 * 12);
  const std::string text = comment(report, "long");
  EXPECT_LT(text.size(), 15'000u);
  EXPECT_GT(markdown(report, "long").size(), 500'000u);
  EXPECT_THAT(text, StartsWith("### long: FAILED\n\n| method "));
  for (int method = 0; method < 9; ++method) {
    EXPECT_THAT(text, HasSubstr(fmt::format("| method_{} |    64 |         768 |", method)));
  }
  EXPECT_THAT(text, HasSubstr("### The worst 20 of 576 cells with findings\n\n| cell "));
  // Record 4000 is score 4 of method 0 in repeat 37; its cell has eleven further findings.
  const std::string worst =
      "score_4 translation 3d, dense, loopbench: rmse 3 m, was 1 (+200 %, limit 0.001) |   11 |";
  EXPECT_THAT(text, HasSubstr(worst));
  EXPECT_LT(text.find(worst), text.find("score_11 "));
  EXPECT_THAT(text, HasSubstr("---: |\n| room (repeat 37) / method_0 | regression | "));
  EXPECT_LT(comment(worse_everywhere(std::string(5000, 'x')), "long").size(), 30'000u);
}

TEST(GateText, IsCompleteInACommentOnFewFindings) {
  const GateReport report = after([](Snapshot& now) { rmse(now, 3) *= 2.0; });
  EXPECT_EQ(comment(report, "quick"), markdown(report, "quick"));
}

TEST(GateText, NamesTheReasonOfACellThatFails) {
  Baseline broken = baseline();
  fail(broken.snapshot, 0, Status::failed);
  Snapshot now = broken.snapshot;
  now.records[0].why = "no solution";
  const GateReport report = check(broken, now);
  EXPECT_THAT(markdown(report, "q"),
              StartsWith("### q: passed; 1 cell fails as in the baseline\n"));
  EXPECT_THAT(junit(report, "q"), HasSubstr("<failure message=\"failed: no solution\">"));
}

TEST(GateText, DoubtsErrorsThatVanish) {
  const auto doubts = [](double factor) {
    const GateReport report = after([&](Snapshot& now) { rmse(now, 3) *= factor; });
    return std::ranges::count_if(report.notes, [](const std::string& note) {
      return note.starts_with(
          "implausible: 1 number has hardly any error left (at most 1 % of "
          "it; first: room (repeat 1) / uniform, ate translation 3d, ");
    });
  };
  EXPECT_EQ(doubts(1e-9), 1);
  EXPECT_EQ(doubts(0.02), 0);
}

}  // namespace
}  // namespace loopbench::gate_snapshot::gate_file_test
