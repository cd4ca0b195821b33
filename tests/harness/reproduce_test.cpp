#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "harness/article/heat_map.hpp"
#include "harness/article/ledger.hpp"
#include "harness/article/paper_tables.hpp"
#include "harness/article/reported.hpp"
#include "harness/article/run_pages.hpp"
#include "harness/plot/gnuplot.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::reproduce_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

TEST(Reported, HasSixteenRowsOfWhichFourCannotBeTrue) {
  EXPECT_EQ(reported_rows().size(), 16u);
  std::vector<std::string> flawed;
  for (const ReportedRow& row : reported_rows()) {
    if (!contradiction(row).empty()) {
      flawed.push_back(std::to_string(row.table) + " " + row.variant);
    }
  }
  EXPECT_EQ(flawed, (std::vector<std::string>{"1 ORB_SLAM2", "1 N3", "1 N5", "4 M6"}));
}

Score along(const std::string& axis, double rmse) {
  Score score{"translation", axis, "m", {}};
  score.statistics = {10, rmse, 0.8 * rmse, 0.8 * rmse, 0.1 * rmse, 0.0, 2.0 * rmse, 0.0};
  return score;
}

/// A closed run of fr1_room whose y error is `y` at keyframes and `y_dense` between.
PaperCell cell(const std::string& variant, double y, double y_dense, double roughness) {
  PaperCell out;
  out.sequence = "fr1_room";
  out.input = "closed";
  out.reading = variant == "ORB_SLAM2" ? "" : "text";
  out.variant = variant;
  out.roughness = roughness;
  for (const Times times : {Times::keyframes, Times::dense}) {
    const double error = times == Times::dense ? y_dense : y;
    for (const char* metric : {"axis_error", "rpe", "ate"}) {
      for (const char* axis : {"y", "3d"}) {
        ScoreResult score;
        score.times = times;
        score.metric = score.label = metric;
        score.score = along(axis, error);
        out.result.scores.push_back(score);
      }
    }
  }
  for (int i = 0; i < 20; ++i) {  // better in the first half only
    const double t = i;
    const double error = variant == "ORB_SLAM2" ? 0.1 : i < 10 ? 0.05 : 0.2;
    out.dense.reference.push_back({t, {Rotation::Identity(), Vector3(t, 0, 0)}});
    out.dense.estimate.push_back({t, {Rotation::Identity(), Vector3(t, error, 0)}});
  }
  out.keyframes = out.dense.estimate;
  return out;
}

const LedgerItem& item(const std::vector<LedgerItem>& items,
                       const std::string& where,
                       const std::string& statement = "") {
  return *std::ranges::find_if(items, [&](const LedgerItem& i) {
    return i.where == where && i.statement.find(statement) != std::string::npos;
  });
}

TEST(Verdict, NeedsTheSignAndAComparableSize) {
  EXPECT_EQ(verdict_on_change(-0.34, -0.30), Verdict::holds);
  EXPECT_EQ(verdict_on_change(-0.34, -0.10), Verdict::other_size);
  EXPECT_EQ(verdict_on_change(0.71, 0.012), Verdict::other_size);  // Table 3, N5
  EXPECT_EQ(verdict_on_change(0.71, 0.009), Verdict::tie);
  EXPECT_EQ(verdict_on_change(-0.34, 0.2), Verdict::does_not_hold);
  EXPECT_EQ(verdict_on_change(0.005, -0.002), Verdict::holds);
  EXPECT_EQ(verdict_on_change(0.1, std::nan("")), Verdict::cannot_be_judged);
  EXPECT_EQ(verdict_on_smallest(1.0, 1.1), Verdict::holds);
  EXPECT_EQ(verdict_on_smallest(1.0, 1.005), Verdict::tie);
  EXPECT_EQ(verdict_on_smallest(1.005, 1.0), Verdict::tie);
  EXPECT_EQ(verdict_on_smallest(1.1, 1.0), Verdict::does_not_hold);
  EXPECT_EQ(percent_change(-1e-17), "+0.0 %");
  EXPECT_EQ(percent_change(-0.0996), "-10.0 %");
  EXPECT_EQ(percent_change(0.126), "+13 %");
}

TEST(Ledger, IsDecidedByOurNumbersOverAllRuns) {
  std::vector<PaperCell> cells{cell("ORB_SLAM2", 0.04, 0.05, 3.0),
                               cell("N3", 0.03, 0.049, 2.0),
                               cell("N4 parabola", 0.04, 0.048, 4.0),
                               cell("N5 cubic", 0.05, 0.060, 2.0)};
  for (std::size_t k = 0; k < 4; ++k) {  // a second run, where N3 raises the error
    PaperCell other = cells[k];
    other.input = "open";
    if (other.variant == "N3") {
      for (ScoreResult& s : other.result.scores) s.score.statistics.rmse = 0.06;
    }
    cells.push_back(other);
  }
  const std::vector<LedgerItem> items = table_items(cells);
  const LedgerItem& n3 = item(items, "Table 1, N3", "ATE along y");
  EXPECT_EQ(n3.verdict, Verdict::holds);  // -25 % against the printed -34 %
  EXPECT_TRUE(n3.ours.starts_with("text -25 % at keyframes, -2.0 % densely")) << n3.ours;
  EXPECT_EQ(n3.runs, "-25 % to +50 % in 2 runs; printed sign in 1");
  EXPECT_EQ(item(items, "Table 1, N4").verdict, Verdict::tie);
  EXPECT_EQ(item(items, "Table 1, N5", "ATE along y").verdict, Verdict::does_not_hold);
  EXPECT_EQ(item(items, "Table 1, N5", "mean").verdict, Verdict::contradicts_itself);
  EXPECT_EQ(item(items, "Text, figure 6").verdict, Verdict::holds);  // 0.048 against 0.049
  EXPECT_EQ(item(items, "Table 1, mean and ATE").verdict, Verdict::holds);
  EXPECT_EQ(item(items, "Table 3, N3").verdict, Verdict::cannot_be_judged);  // no such sequence

  const std::vector<LedgerItem> overall = trajectory_items(cells);
  const LedgerItem& level = item(overall, "Section 4.2", "text N4 parabola: the same level");
  EXPECT_EQ(level.verdict, Verdict::holds);
  EXPECT_EQ(level.ours, "3-D ATE densely 0.0480 against 0.0500 m (-4.0 %)");
  EXPECT_EQ(item(overall, "Section 4.2", "text N4 parabola: better").ours,
            "lower rmse in 5 of 10 tenths of the time");
  EXPECT_EQ(item(overall, "Section 4.2", "text N4 parabola: smoother").verdict,
            Verdict::does_not_hold);
}

/// fr3_office, closed, on a circle: 0.3 m/s, 0.045 rad per keyframe.
PaperCell circling() {
  PaperCell out;
  out.sequence = "fr3_office";
  out.input = "closed";
  out.variant = "ORB_SLAM2";
  const auto at = [](double t) {
    const double angle = 0.045 * 3.0 * t;
    const double radius = 0.1 / 0.045;
    return StampedPose{
        t, {Rotation::Identity(), radius * Vector3(std::sin(angle), 1.0 - std::cos(angle), 0.0)}};
  };
  for (int i = 0; i < 30; ++i) out.keyframes.push_back(at(i / 3.0));
  for (int i = 0; i < 300; ++i) out.dense.reference.push_back(at(i / 30.0));
  return out;
}

TEST(SegmentItems, CompareFamiliesAtTheirOwnN) {
  const std::vector<LedgerItem> items = segment_items({circling()});
  // 26 windows of five nodes, 27 of four, 28 of three; cubics are nearer to a circle's arc, by
  // hundredths of a millimetre.
  const LedgerItem& figure = item(items, "Figure 7 a c e");
  for (const char* part :
       {"(28 windows)", "(27 windows)", "(26 windows)", "27 windows also have"}) {
    EXPECT_NE(figure.ours.find(part), std::string::npos) << figure.ours;
  }
  EXPECT_NE(item(items, "Figure 8 left").ours.find("; 0 windows also have the quoted kappa"),
            std::string::npos);
  EXPECT_EQ(item(items, "Text, special segment").verdict, Verdict::cannot_be_judged);
}

TEST(EquationItems, AreDecidedByComputation) {
  const std::vector<LedgerItem> items = equation_items({circling()});
  EXPECT_EQ(item(items, "Equation 12").verdict, Verdict::misprint);
  EXPECT_NE(item(items, "Equation 10").ours.find("order 2 has 9 unknowns"), std::string::npos);
}

TEST(HeatMap, WritesTableAndFigure) {
  const HeatMap map{
      "a", "band", "threshold", {"0.1", "0.2"}, {"1", "2"}, {{1.0, -2.0}, {0.5, NAN}}};
  EXPECT_EQ(heat_table(map),
            "\n| band \\ threshold | 1 | 2 |\n| ---: | ---: | ---: |\n"
            "| 0.1 | +1.0 | -2.0 |\n| 0.2 | +0.5 | |\n");
  const TemporaryFolder folder;
  write_heat_maps(folder.path() / "map.svg", {map, map});
  std::ifstream in(folder.path() / "map.svg");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_NE(text.find("fill=\"#ff4040\""), std::string::npos);  // the largest loss
  EXPECT_NE(text.find("</svg>"), std::string::npos);
}

TEST(RunPages, MarkWhatUsesTheReference) {
  std::vector<PaperCell> cells{cell("ORB_SLAM2", 0.04, 0.05, 3.0), cell("N3", 0.03, 0.045, 2.0)};
  cells[1].result.oracle_method = true;
  cells[1].result.report.notes = {"oracle: uses the axes"};
  const std::string text = method_tables(cells, "ORB_SLAM2");
  EXPECT_NE(text.find("## fr1_room closed"), std::string::npos) << text;
  EXPECT_NE(text.find("| text N3 (oracle) | 30.0 | 30.0 | 45.0 | 45.0 | -10 % |"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("oracle: uses the axes."), std::string::npos);
}

TEST(PaperTables, PutOurRowsBeneathThePrintedOnes) {
  const std::string text = paper_tables({cell("N3", 0.03, 0.049, 2.0)});
  EXPECT_NE(
      text.find("| N3 | **printed** | 0.0888 | 0.0003 | 0.0296 | 0.0365 | 0.1045 |  |  | "
                "contradicts itself: RPE is 2.86 times the ATE, at most 2 is possible for "
                "errors of the same axis |\n"
                "| N3 | text | 0.0600 | 0.0000 | 0.0240 | 0.0300 | 0.0300 | 0.0490 |  |  |\n"),
      std::string::npos)
      << text;
}

TEST(Plot, ThinsWhatIsDrawnAndKeepsTheEnds) {
  std::vector<Vector3> points(1000);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].x() = static_cast<double>(i);
  const std::vector<Vector3> few = thinned(points, 100);
  EXPECT_LE(few.size(), 100u);
  EXPECT_GE(few.size(), 90u);
  EXPECT_EQ(few.front().x(), 0.0);
  EXPECT_EQ(few.back().x(), 999.0);
  EXPECT_EQ(thinned(points, 1000).size(), 1000u);
}

TEST(Plot, WritesAWholeSvgAndEscapesNames) {
  if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "gnuplot is absent";
  TemporaryFolder folder;
  PlotPanel panel;
  panel.title = "it's <here>\nand there";
  panel.series = {{"a'b & c", "#ff0000", false, {{0, 0, 0}, {1, 2, 0}}}};
  PlotPanel spatial = panel;
  spatial.spatial = true;
  write_figure(folder.path() / "new" / "two.svg", {panel, spatial}, 2);
  std::ifstream in(folder.path() / "new" / "two.svg");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_NE(text.find("</svg>"), std::string::npos);
  EXPECT_NE(text.find("s &lt;here> and there"), std::string::npos);
  EXPECT_NE(text.find("b &amp; c"), std::string::npos);
}

}  // namespace
}  // namespace loopbench::reproduce_test
