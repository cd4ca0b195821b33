/// Items of the ledger and summaries of pages on small runs whose answer is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "harness/article/ledger.hpp"
#include "harness/article/printed_curves.hpp"
#include "harness/article/rank_correlation.hpp"
#include "harness/article/run_pages.hpp"

namespace loopbench::paper_items_test {

using namespace harness;

namespace {

const LedgerItem& item(const std::vector<LedgerItem>& items, const std::string& statement) {
  const auto it = std::ranges::find_if(
      items, [&](const LedgerItem& i) { return i.statement.find(statement) != std::string::npos; });
  if (it == items.end()) throw std::runtime_error("no item " + statement);
  return *it;
}

TEST(RankCorrelation, IsOneForAnyMonotoneRelation) {
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {1, 8, 27, 64}), 1.0);
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {4, 3, 2, -9}), -1.0);
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {2, 1, 4, 3}), 0.6);  // 1 - 6 * 4 / 60
  EXPECT_TRUE(std::isnan(rank_correlation({1, 2}, {1, 2})));
}

/// A straight path whose error grows with distance; the camera rotates less where it is faster.
PaperCell drifting() {
  PaperCell out;
  out.sequence = "fr1_room";
  out.input = "closed";
  out.variant = "ORB_SLAM2";
  double x = 0.0, angle = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double more = 0.01 * ((7 * i) % 13);
    x += 0.1 + more;
    angle += 0.2 - more;
    const Pose truth{Rotation(Eigen::AngleAxisd(angle, Vector3::UnitZ())), {x, 0.0, 0.0}};
    out.dense.reference.push_back({static_cast<double>(i), truth});
    out.keyframes.push_back({static_cast<double>(i), {truth.rotation, {1.02 * x, 0.0, 0.0}}});
  }
  return out;
}

TEST(TrajectoryItems, RelateTheErrorOfAStepToSpeedAndRotation) {
  const std::vector<LedgerItem> items = trajectory_items({drifting()});
  const LedgerItem& speed = item(items, "related to the speed");
  EXPECT_EQ(speed.verdict, Verdict::holds);
  // 59 steps: three standard errors are 3 / sqrt(58).
  EXPECT_NE(speed.ours.find("above 0.39 counts"), std::string::npos) << speed.ours;
  EXPECT_NE(speed.runs.find("related in 1 of 1 runs"), std::string::npos) << speed.runs;
  EXPECT_EQ(item(items, "related to the rotation angle").verdict, Verdict::does_not_hold);
}

TEST(TableItems, CompareTheTextWithThePrintedTables) {
  const std::vector<LedgerItem> items = table_items({});
  const LedgerItem& first = item(items, "fr1_room: N4 fits the complete run best");
  EXPECT_EQ(first.ours,
            "its printed row has mean 0.0329, ATE 0.041; N3 has mean 0.0296, ATE 0.0365");
  EXPECT_EQ(first.verdict, Verdict::contradicts_itself);
  EXPECT_EQ(item(items, "fr3_office: M7 fits").ours,
            "its printed row has mean 0.0154, ATE 0.0332; M8 has mean 0.0146, ATE 0.0314");
  EXPECT_EQ(item(items, "ATE below ORB_SLAM2's in 8 of 12 rows").verdict,
            Verdict::cannot_be_judged);  // without any run
}

/// A run on y = f(x) + offset of a printed curve.
PaperCell on_curve(const PrintedCurve& curve, double offset) {
  PaperCell out;
  out.sequence = curve.sequence;
  out.input = "closed";
  out.variant = "ORB_SLAM2";
  for (int i = 0; i < 200; ++i) {
    const double x = 0.002 * i;
    const StampedPose pose{0.01 * i, {Rotation::Identity(), {x, curve.f(x) + offset, 1.4}}};
    out.dense.reference.push_back(pose);
    if (i % 20 == 0) out.keyframes.push_back(pose);
  }
  return out;
}

TEST(CoefficientItems, AreEvaluatedByTheAteOfTheArticlesTable) {
  const PrintedCurve& parabola = printed_curves().front();  // N = 3 on fr1_room, ATE 0.0365 m
  const auto verdict = [&](double offset) {
    return item(coefficient_items({on_curve(parabola, offset)}), parabola.text).verdict;
  };
  EXPECT_EQ(verdict(0.0), Verdict::holds);
  EXPECT_EQ(verdict(0.0364), Verdict::holds);
  EXPECT_EQ(verdict(0.038), Verdict::tie);
  EXPECT_EQ(verdict(0.04), Verdict::does_not_hold);
}

PaperCell with_ate(const std::string& input, const std::string& method, double ate) {
  PaperCell out;
  out.sequence = "room";
  out.input = input;
  out.reading = method;
  ScoreResult score;
  score.times = metrics::Times::dense;
  score.metric = score.label = "ate";
  score.score = {"translation", "3d", "m", {}};
  score.score.statistics.rmse = ate;
  out.result.scores.push_back(score);
  for (int i = 0; i < 4; ++i) out.keyframes.push_back({1.0 * i, {}});
  return out;
}

TEST(GainMatrix, SummarisesEachKeyframeInterval) {
  std::vector<PaperCell> cells;
  for (const auto& [run, ate] : {std::pair{"a", 0.9}, std::pair{"b", 0.8}, std::pair{"c", 1.3}}) {
    const std::string input = std::string(run) + " (keyframes.value=0.8)";
    cells.push_back(with_ate(input, "polyline", 1.0));
    cells.push_back(with_ate(input, "spline", ate));
  }
  cells.push_back(with_ate("a (keyframes.value=1.6)", "polyline", 2.0));
  cells.push_back(with_ate("a (keyframes.value=1.6)", "spline", 1.0));
  const std::string text = gain_matrix(cells, "polyline");
  EXPECT_NE(text.find("| interval at least [s] | spline |\n| ---: | ---: |\n"
                      "| 0.8 | +10.0 (2 of 3) |\n| 1.6 | +50.0 (1 of 1) |\n"),
            std::string::npos)
      << text;
}

}  // namespace
}  // namespace loopbench::paper_items_test
