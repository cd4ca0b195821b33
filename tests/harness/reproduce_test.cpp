#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "harness/article/claims.hpp"
#include "harness/article/paper_tables.hpp"
#include "harness/article/reported.hpp"
#include "harness/article/segment_claims.hpp"
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
  out.reading = variant == "ORB_SLAM2" ? "" : "robust";
  out.variant = variant;
  out.roughness = roughness;
  for (const Times times : {Times::keyframes, Times::dense}) {
    const double error = times == Times::dense ? y_dense : y;
    for (const char* metric : {"axis_error", "rpe", "ate"}) {
      for (const char* axis : {"y", "3d"}) {
        ScoreResult score;
        score.times = times;
        score.metric = metric;
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
  return out;
}

const Claim& claim(const std::vector<Claim>& claims, const std::string& begin) {
  return *std::ranges::find_if(claims, [&](const Claim& c) { return c.text.starts_with(begin); });
}

TEST(Claims, AreDecidedByOurNumbers) {
  const std::vector<PaperCell> cells{cell("ORB_SLAM2", 0.04, 0.05, 3.0),
                                     cell("N3", 0.03, 0.049, 2.0),
                                     cell("N4", 0.04, 0.048, 4.0),
                                     cell("N5", 0.05, 0.060, 2.0)};
  const std::vector<Claim> claims = check_claims(cells, "robust");
  EXPECT_EQ(claim(claims, "Table 1: N3 lowers the y ATE").verdict, Verdict::holds);
  EXPECT_EQ(claim(claims, "Table 1: N4 lowers the y ATE").verdict, Verdict::does_not_hold);
  EXPECT_EQ(claim(claims, "Table 1: N4").because,
            "does not change it: 0.0400 against 0.0400 m at keyframes, 0.0480 against 0.0500 "
            "between");
  EXPECT_EQ(claim(claims, "Table 1: N5").verdict, Verdict::does_not_hold);
  EXPECT_EQ(claim(claims, "Table 1 (mean").verdict, Verdict::does_not_hold);  // N4 is best
  EXPECT_EQ(claim(claims, "Text, fr1_room: N4").verdict, Verdict::holds);
  EXPECT_EQ(claim(claims, "N4: the same level").verdict, Verdict::holds);  // 4 % apart
  EXPECT_EQ(claim(claims, "N4: better").because, "lower rmse in 5 of 10 tenths of the time");
  EXPECT_EQ(claim(claims, "N4: smoother").verdict, Verdict::does_not_hold);
  EXPECT_EQ(claim(claims, "Table 3").verdict, Verdict::cannot_be_judged);  // no such sequence
  EXPECT_NE(claim_table(claims).find("*cannot be judged* | no such run |"), std::string::npos);
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

TEST(SegmentClaims, AreJudgedWhereSpeedAndCurvatureAreAsQuoted) {
  const std::vector<Claim> claims = check_segment_claims({circling()});
  // Symmetric nodes give the cubic no cubic term: parabola and cubic tie, to 0.01 mm on this arc.
  const Claim& parabola = claim(claims, "Figure 7 a c e: a parabola at 0.2017 to 0.3832 m/s");
  EXPECT_EQ(parabola.verdict, Verdict::holds) << parabola.because;
  EXPECT_TRUE(
      parabola.because.starts_with("in both ranges 26 windows, parabola 0.00 mm, cubic 0.00 mm"))
      << parabola.because;
  // The same speeds with larger rotations: only the speeds are used.
  const Claim& faster = claim(claims, "Figure 8 left: a parabola at 0.1998 to 0.3035 m/s");
  EXPECT_EQ(faster.verdict, Verdict::holds) << faster.because;
  EXPECT_TRUE(faster.because.starts_with("in both ranges 0 windows; by speed alone 26 windows"))
      << faster.because;
  EXPECT_EQ(claim(claims, "Text, special segment: a rational").verdict, Verdict::cannot_be_judged);
  // Parabolas through a circle meet at a small angle at any speed.
  EXPECT_EQ(claim(claims, "Text: segments meet C1").verdict, Verdict::does_not_hold);
}

TEST(PaperTables, PutOurRowsBeneathThePrintedOnes) {
  const std::string text = paper_tables({cell("N3", 0.03, 0.049, 2.0)});
  EXPECT_NE(text.find("| N3 | **printed** | 0.0888 | 0.0003 | 0.0296 | 0.0365 | 0.1045 |  | cannot "
                      "be true: RPE is 2.86 times the ATE, at most 2 is possible |\n"
                      "| N3 | closed, robust | 0.0600 | 0.0000 | 0.0240 | 0.0300 | 0.0300 | 0.0490 "
                      "|  |\n"),
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
