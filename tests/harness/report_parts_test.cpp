/// Building blocks of the report page: escaped text, packed numbers, the amount of data, the rule
/// of the Pareto front.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "datasets/core/error.hpp"
#include "harness/answers/report/assets.hpp"
#include "harness/answers/report/data.hpp"
#include "harness/answers/report/report.hpp"
#include "harness/answers/report/sections.hpp"
#include "tests/studies/synthetic_store.hpp"
#include "tests/support/compared_sweep.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::compared_sweep::report_parts_test {
namespace {

TEST(Html, EscapesWhatMarkupIsMadeOf) {
  EXPECT_EQ(html_text("<b a=\"1\" c='2'>&\x01"), "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;");
  EXPECT_EQ(html_text("drehung °"), "drehung °");
}

TEST(Html, NothingInAScriptEndsIt) {
  const std::string text = script_text(nlohmann::json("</script><!--").dump());
  EXPECT_EQ(text, "\"\\u003c/script>\\u003c!--\"");
  EXPECT_EQ(nlohmann::json::parse(text), "</script><!--");
}

TEST(Html, TablesEscapeAndMark) {
  const Table table{"a<b", {"method", "x"}, {{{"m&m"}, {"1.0", true}}}, {"note <i>"}};
  const std::string html = html_table(table);
  EXPECT_NE(html.find("<caption>a&lt;b</caption>"), std::string::npos);
  EXPECT_NE(html.find("<th scope=\"row\">m&amp;m</th><td class=\"best\">1.0</td>"),
            std::string::npos);
  EXPECT_NE(html.find("<li>note &lt;i&gt;</li>"), std::string::npos);
}

TEST(Packed, IsSixteenBitsOfTheRange) {
  // 0, half of 65534 and 65534 as little-endian words; then NaN.
  const auto json = packed({-1.0, 0.0, 1.0, std::nan("")});
  EXPECT_EQ(json["low"], -1.0);
  EXPECT_NEAR(json["step"].get<double>(), 2.0 / 65534.0, 1e-11);
  EXPECT_EQ(json["words"], "AAD/f/7///8=");
  EXPECT_EQ(packed({})["words"], "");
  EXPECT_EQ(packed({5.0, 5.0})["words"], "AAAAAA==");
}

TEST(Packed, ThinsWithBothEndsKept) {
  EXPECT_EQ(subsampled_indices(3, 5), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(subsampled_indices(101, 3), (std::vector<std::size_t>{0, 50, 100}));
  EXPECT_EQ(subsampled_indices(9, 1), (std::vector<std::size_t>{0}));
  EXPECT_TRUE(subsampled_indices(0, 5).empty());
}

TEST(Thinning, LeavesOutRepeatsThenDrawsCoarserCurves) {
  const std::vector<double> repeats{1000.0, 1000.0, 500.0};
  const auto is_thinned = [&](double bytes, double coarser, std::size_t kept) {
    const Thinning out = thinning_for(repeats, bytes);
    EXPECT_EQ(out.repeats, kept) << bytes;
    EXPECT_NEAR(out.deviation, coarser * kTraceDeviation, 1e-12) << bytes;
  };
  is_thinned(1e9, 1.0, 3);
  is_thinned(2500.0, 1.0, 3);
  is_thinned(2499.0, 1.0, 2);
  is_thinned(1000.0, 1.0, 1);
  is_thinned(500.0, 2.0, 1);
  EXPECT_EQ(thinning_for(repeats, 0.0), thinning_for(repeats, 1e-9));
  EXPECT_EQ(thinning_for({}, 0.0).repeats, 1u);
}

TEST(DefaultMethods, AreTheBaselineTheBestAndTheBestWithoutASmoother) {
  ReportContent content;
  for (const char* const name : {"raw", "a", "b", "a + s"}) {
    CellRow& cell = content.cells.emplace_back();
    cell.method = name;
    cell.parts.corrector = std::string(name).substr(0, 3);
  }
  content.cells.back().parts = {.corrector = "a", .smoother = "s"};
  Comparison& ranked = content.comparisons.emplace_back();
  ranked.options.baseline = "raw";
  for (const char* const name : {"a + s", "b", "a", "raw"}) {
    ranked.methods.emplace_back().method = name;
    ranked.methods.back().median = 1.0;
  }
  EXPECT_EQ(default_methods(content), (std::vector<std::string>{"raw", "a + s", "b"}));
  content.cells.clear();  // no chains
  EXPECT_EQ(default_methods(content), (std::vector<std::string>{"raw", "a + s", "b", "a"}));
}

/// Ten sequences of 40 methods.
TEST(Report, LeavesOutSequencesThatDoNotFit) {
  std::vector<Record> records;
  for (int i = 0; i < 400; ++i) {
    Record& r =
        records.emplace_back(compared_sweep::ate("m" + std::to_string(i % 40), 1.0 + i % 40));
    r.cell.edit().position = i;
    r.cell.edit().sequence = "sequence " + std::to_string(i / 40);
    r.statistics.mean = r.statistics.rmse;
  }
  const TemporaryFolder folder;
  synthetic::write_store(records, folder.path());
  const ReportContent content = read_report_content(folder.path());
  EXPECT_EQ(content.shown, 10u);
  const std::string whole = report_html(content);
  EXPECT_EQ(whole.find("sequences, because"), std::string::npos);

  const std::string part = report_html(content, whole.size() - 1000);
  EXPECT_LT(part.size(), whole.size() - 1000);
  EXPECT_NE(part.find("show the first 9 of 10 sequences"), std::string::npos);
  EXPECT_NE(part.find("data-sequence=\"sequence 8\""), std::string::npos);
  EXPECT_EQ(part.find("data-sequence=\"sequence 9\""), std::string::npos);
  EXPECT_NE(part.find("m1 is 100 % above m0"), std::string::npos)
      << "verdicts cover all: " << part.substr(part.find("10 sequences"), 300);

  const ReportContent little = read_report_content(folder.path(), 1000);
  EXPECT_EQ(little.shown, 3u);  // 100 records of 40 each
  EXPECT_EQ(little.shown_cells.size(), 120u);
  EXPECT_EQ(little.cells.size(), 400u);
  EXPECT_THROW(report_html(content, 1000), InputError);
}

/// The page's script front.js on these points, as node runs it: "1" on the front, "0" off it.
std::string front_of_the_page(const std::vector<double>& errors, const std::vector<double>& times) {
  const auto script = std::ranges::find(assets(), "page/front.js", &Asset::name);
  const TemporaryFolder folder;
  const auto file = folder.file("front.js",
                                "const window = {R: {}};\n" + std::string(script->text) +
                                    "const ms = " + nlohmann::json(times).dump() +
                                    ", all = " + nlohmann::json(errors).dump() +
                                    ".map((error, i) => ({error, ms: ms[i]}));\n"
                                    "const front = window.R.front(all);\n"
                                    "require('fs').writeFileSync(process.argv[2], all.map((p) => "
                                    "(front.includes(p) ? '1' : '0')).join(''));\n");
  const auto out = folder.path() / "out";
  const std::string line = "node '" + file.string() + "' '" + out.string() + "'";
  EXPECT_EQ(std::system(line.c_str()), 0);
  std::string text;
  std::ifstream(out) >> text;
  return text;
}

TEST(ReportPage, KeepsWhatNothingBeatsInBoth) {
  if (std::system("command -v node >/dev/null 2>&1") != 0) GTEST_SKIP() << "needs node";
  EXPECT_EQ(front_of_the_page({1, 2, 3, 2, 4}, {4, 2, 3, 3, 1}), "11001");
  EXPECT_EQ(front_of_the_page({1, 1, 1}, {2, 2, 3}), "110");  // equals stay
  EXPECT_EQ(front_of_the_page({1, 1 - 1e-7}, {1, 15}),
            "10");  // a relative difference that counts as none
  EXPECT_EQ(front_of_the_page({1, 1 - 1e-5}, {1, 15}), "11");
}

TEST(ReportPage, NoiseOfTimesChangesNoFront) {
  if (std::system("command -v node >/dev/null 2>&1") != 0) GTEST_SKIP() << "needs node";
  // The second and the third take the same time, the fourth takes a fifth more.
  EXPECT_EQ(front_of_the_page({4, 3, 2, 1}, {1, 2, 2, 2.4}), "1011");
  EXPECT_EQ(front_of_the_page({4, 3, 2, 1}, {0.97, 1.94, 2.06, 2.33}), "1011");
  EXPECT_EQ(front_of_the_page({4, 3, 2, 1}, {1.03, 2.06, 1.94, 2.47}), "1011");
}

}  // namespace
}  // namespace loopbench::compared_sweep::report_parts_test
