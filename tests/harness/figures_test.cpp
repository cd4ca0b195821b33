/// Data of figures: origin of their axes, peaks, names, sizes, and which runs they contain.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "datasets/core/so3.hpp"
#include "harness/commands/correct/correct.hpp"
#include "harness/commands/eval/eval_figures.hpp"

namespace loopbench::figures_test {
namespace {

using namespace harness;
using testing::ElementsAre;

/// 1 m/s along x with a bend in z, from `first` to `last` [s], one pose per second.
Trajectory path(double first, double last, double error = 0.0) {
  Trajectory out;
  for (double t = first; t <= last; t += 1.0) {
    out.push_back({100.0 + t, {Rotation::Identity(), {t, error * (int(t) % 2), 0.0}}});
  }
  return out;
}

std::vector<DrawnCurve> drawn(const Trajectory& reference, const Trajectory& estimate) {
  metrics::Protocol protocol;
  protocol.align = metrics::Align::none;
  return drawn_evaluation(reference, metrics::evaluate(reference, estimate, protocol));
}

TEST(Figures, AllEstimatesHaveTheOriginOfTheReference) {
  const std::vector<DrawnCurve> one = drawn(path(0.0, 50.0), path(20.0, 45.0, 0.1));
  EXPECT_NEAR(one[1].columns.at("time").front(), 20.0, 1e-9);
  EXPECT_NEAR(one[1].columns.at("time").back(), 45.0, 1e-9);
  EXPECT_EQ(one[0].name, "reference");
  EXPECT_NEAR(one[0].columns.at("time").front(), 0.0, 1e-9);
  EXPECT_NEAR(one[0].columns.at("time").back(), 50.0, 1e-9);
  EXPECT_NEAR(one[0].columns.at("x").back(), 50.0, 1e-9);
  EXPECT_NEAR(*one[1].rmse, std::sqrt(0.5) * 0.1, 1e-9);
}

TEST(Figures, KeepThePeakOfAnErrorWithFewerPoints) {
  const Trajectory reference = path(0.0, 4999.0);
  Trajectory estimate = reference;
  estimate[3217].world_from_body.translation.y() = 4.0;  // of one pose only
  const std::vector<DrawnCurve> one = drawn(reference, estimate);
  const std::vector<double>& errors = one[1].columns.at("error");
  EXPECT_EQ(std::ranges::max(errors), 4.0);
  EXPECT_EQ(one[1].columns.at("sorted_errors").back(), 4.0);
  EXPECT_EQ(one[1].columns.at("time").front(), 0.0);
  EXPECT_EQ(one[1].columns.at("time").back(), 4999.0);
  EXPECT_EQ(one[1].columns.at("time").size(), errors.size());
  EXPECT_LE(errors.size(), 5 * 1000u);
  EXPECT_LE(one[0].columns.at("time").size(), 1001u);
}

/// Distance of a point from a polyline.
double distance_from(const DrawnCurve& line, double x, double y) {
  const std::vector<double>& xs = line.columns.at("x");
  const std::vector<double>& ys = line.columns.at("y");
  double out = INFINITY;
  for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
    const double dx = xs[i + 1] - xs[i], dy = ys[i + 1] - ys[i], square = dx * dx + dy * dy;
    const double u =
        square > 0.0 ? std::clamp(((x - xs[i]) * dx + (y - ys[i]) * dy) / square, 0.0, 1.0) : 0.0;
    out = std::min(out, std::hypot(x - xs[i] - u * dx, y - ys[i] - u * dy));
  }
  return out;
}

TEST(Figures, OfLongRunsDeviateByNoMoreThanHalfALine) {
  constexpr std::size_t kRows = 20'000;
  DrawnCurve all{.name = "laps"};
  for (std::size_t i = 0; i < kRows; ++i) {  // 40 laps in 1000 rows would be polygons of 25 corners
    const double angle = 2.0 * M_PI * 40.0 * static_cast<double>(i) / kRows;
    add_position(all, {100.0 * std::cos(angle), 60.0 * std::sin(angle), 0.0});
  }
  DrawnCurve thinned = all;
  thin(thinned);
  EXPECT_LT(thinned.columns.at("x").size(), kRows / 4);
  for (std::size_t i = 0; i < kRows; i += 97) {
    const double x = all.columns.at("x")[i], y = all.columns.at("y")[i];
    EXPECT_LE(distance_from(thinned, x, y), 0.002 * 200.0 / 2.0) << i;
  }
  const std::size_t rows = thinned.columns.at("x").size();
  thin(thinned);
  EXPECT_EQ(thinned.columns.at("x").size(), rows);
}

TEST(Figures, WithAScriptHaveAllData) {
  NamedTrajectory one{"long", {}, {}};
  one.file.poses = path(0.0, 4999.0, 0.1);
  const FigureData data = trajectory_figure({one}, std::nullopt, default_trajectory_panels(), {});
  EXPECT_EQ(data.curves[0].columns.at("x").size(), 5000u);  // draw() thins it without a script
}

TEST(Figures, OfACorrectionWithAScriptHaveAllData) {
  Correction done;
  done.problem.keyframes = path(0.0, 4999.0, 0.1);
  done.keyframes = path(0.0, 4999.0);
  for (const DrawnCurve& curve : before_and_after(done).curves)
    EXPECT_EQ(curve.columns.at("x").size(), 5000u);
}

TEST(Figures, OfATrajectoryHaveNoSpeedOfOnePose) {
  NamedTrajectory one{"turning", {}, {}};
  one.file.poses = {{1.0, {exp_so3({0.0, 0.0, 0.5}), Vector3::Zero()}},
                    {2.0, {exp_so3({0.0, 0.0, 1.0}), Vector3::UnitX()}}};
  const auto columns = [&] {
    return trajectory_figure({one}, std::nullopt, default_trajectory_panels(), {})
        .curves[0]
        .columns;
  };
  EXPECT_THAT(columns().at("speed"), ElementsAre(1.0, 1.0));
  one.file.poses.resize(1);
  EXPECT_FALSE(columns().contains("speed"));
}

FigureData drawn(const std::string& reference, const std::vector<std::string>& estimates) {
  std::vector<EvaluationResult> results;
  for (const std::string& estimate : estimates) {
    EvaluationResult& each = results.emplace_back();
    each.estimate = estimate;
    each.drawn = {reference_curve(), {.rmse = 0.1}};
  }
  return drawn_runs(results, labelled_runs(reference, estimates, ""));
}

std::vector<std::string> names(const FigureData& data) {
  std::vector<std::string> out;
  for (const DrawnCurve& each : data.curves) out.push_back(each.name);
  return out;
}

TEST(Figures, NamesAreTheShortestThatDiffer) {
  const FigureData all = drawn("t/V.csv", {"ba/V/0.txt", "rp/V/0.txt"});
  EXPECT_THAT(names(all), ElementsAre("reference", "ba", "rp"));
  EXPECT_NE(all.curves[1].style, all.curves[2].style);
  EXPECT_THAT(names(drawn("t.csv", {"x/a/e.txt", "y/a/e.txt"})),
              ElementsAre("reference", "x/a/e.txt", "y/a/e.txt"));
}

TEST(Figures, AllRunsAreDrawn) {
  std::vector<std::string> files;
  for (const char* const method : {"ba", "rp"}) {
    for (int run = 0; run < 5; ++run) {
      files.push_back(std::string(method) + "/W/" + std::to_string(run) + ".txt");
    }
  }
  const FigureData all = drawn("W.csv", files);
  EXPECT_THAT(names(all),
              ElementsAre("reference",
                          "ba 0",
                          "ba 1",
                          "ba 2",
                          "ba 3",
                          "ba 4",
                          "rp 0",
                          "rp 1",
                          "rp 2",
                          "rp 3",
                          "rp 4"));
  EXPECT_EQ(all.note, "");
  EXPECT_EQ(all.title, "W, not aligned. In brackets: position error (RMSE)");
}

TEST(Figures, TheBestOfVeryManyRunsAreDrawn) {
  std::vector<EvaluationResult> results;
  std::vector<std::string> files;
  for (int run = 0; run < 200; ++run) {
    files.push_back("ba_" + std::to_string(run) + ".txt");
    results.emplace_back().drawn = {reference_curve(), {.rmse = 1.0 - 0.001 * run}};
  }
  const FigureData all = drawn_runs(results, labelled_runs("V.csv", files, ""));
  ASSERT_EQ(all.curves.size(), 1 + kMostEstimates);
  EXPECT_EQ(all.curves.front().name, "reference");
  EXPECT_EQ(all.curves[1].name, "ba 104");
  EXPECT_EQ(all.curves.back().name, "ba 199");
  EXPECT_EQ(all.note, "the best 96 of 200 estimates are drawn");
}

}  // namespace
}  // namespace loopbench::figures_test
