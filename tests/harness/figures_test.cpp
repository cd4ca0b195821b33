/// Figures of `eval`: origin of their axes, names, legends, sizes, and which runs they contain.
#include "harness/trajectory/figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/core/so3.hpp"
#include "datasets/formats/formats.hpp"
#include "harness/eval/drawn_sequences.hpp"
#include "harness/eval/error_figures.hpp"
#include "harness/plot/legend.hpp"
#include "tests/support/command.hpp"

namespace loopbench::figures_test {
namespace {

using namespace harness;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

/// 1 m/s along x with a bend in z, from `first` to `last` [s], one pose per second.
Trajectory path(double first, double last, double error = 0.0) {
  Trajectory out;
  for (double t = first; t <= last; t += 1.0) {
    out.push_back({100.0 + t, {Rotation::Identity(), {t, error * (int(t) % 2), 0.0}}});
  }
  return out;
}

DrawnEvaluation drawn(double first, double last) {
  metrics::Protocol protocol;
  protocol.align = metrics::Align::none;
  const Trajectory reference = path(0.0, 50.0);
  return drawn_evaluation(reference,
                          metrics::evaluate(reference, path(first, last, 0.1), protocol));
}

const PlotPanel& panel(const NamedFigure& figure, const std::string& x, const std::string& y) {
  for (const PlotPanel& each : figure.panels) {
    if (each.x_label == x && each.y_label == y) return each;
  }
  throw std::runtime_error("no panel " + x + ", " + y);
}

TEST(Figures, AllEstimatesHaveTheOriginOfTheReference) {
  std::vector<DrawnEvaluation> all{drawn(10.0, 30.0), drawn(20.0, 45.0)};
  all[0].name = "a";
  all[1].name = "b";
  const std::vector<NamedFigure> figures = error_figures(all);
  for (const char* const x : {"time [s]", "distance [m]"}) {  // equal numbers at 1 m/s
    const PlotPanel errors = panel(figures[1], x, "position error [m]");
    EXPECT_NEAR(errors.series[0].points.front().x(), 10.0, 1e-9) << x;
    EXPECT_NEAR(errors.series[1].points.front().x(), 20.0, 1e-9) << x;
    EXPECT_NEAR(errors.series[1].points.back().x(), 45.0, 1e-9) << x;
  }
  const PlotPanel axis = panel(figures[2], "time [s]", "x [m]");
  EXPECT_EQ(axis.series[0].name, "reference");
  EXPECT_NEAR(axis.series[0].points.front().x(), 0.0, 1e-9);
  EXPECT_NEAR(axis.series[0].points.back().x(), 50.0, 1e-9);
  EXPECT_NEAR(axis.series[2].points.front().x(), 20.0, 1e-9);
  EXPECT_NEAR(figures[0].panels[0].series[0].points.back().x(), 50.0, 1e-9);
}

TEST(Figures, KeepThePeakOfAnErrorWithFewerPoints) {
  DrawnEvaluation one;
  for (int i = 0; i < 5000; ++i) {
    const StampedPose pose{0.1 * i, {Rotation::Identity(), Vector3(0.1 * i, 0.0, 0.0)}};
    one.reference.push_back(pose);
    one.estimate.push_back(pose);
    one.times.push_back(pose.stamp);
    one.distances.push_back(pose.stamp);
  }
  one.complete = one.reference;
  one.estimate[3217].world_from_body.translation.y() = 4.0;  // of one pose only
  const auto largest = [](const PlotSeries& series) {
    double out = 0.0;
    for (const Vector3& p : series.points) out = std::max(out, p.y());
    return out;
  };
  const std::vector<NamedFigure> figures = error_figures({one});
  const PlotSeries errors = panel(figures[1], "time [s]", "position error [m]").series[0];
  EXPECT_EQ(largest(errors), 4.0);
  EXPECT_EQ(errors.points.front().x(), 0.0);
  EXPECT_NEAR(errors.points.back().x(), 499.9, 1e-9);
  EXPECT_LE(errors.points.size(), 1010u);
}

TEST(Figures, OfATrajectoryBreakAtWrapsAndHaveNoSpeedOfOnePose) {
  NamedTrajectory turning{"turning", {}, {}};
  for (int i = 0; i < 10; ++i) {
    turning.file.poses.push_back({1.0 * i, {exp_so3({0.0, 0.0, 1.0 * i}), Vector3::Zero()}});
  }
  const std::vector<PlotPanel> panels = trajectory_panels({turning}, std::nullopt);
  const auto yaw = std::ranges::find(panels, "yaw [deg]", &PlotPanel::y_label);
  ASSERT_NE(yaw, panels.end());
  const auto is_break = [](const Vector3& p) { return !p.allFinite(); };
  EXPECT_EQ(std::ranges::count_if(yaw->series[0].points, is_break), 1);  // at 3.14 rad
  turning.file.poses.resize(1);
  for (const PlotPanel& panel : trajectory_panels({turning}, std::nullopt)) {
    EXPECT_NE(panel.y_label, "speed [m/s]");
  }
}

std::vector<EvaluationResult> results(const std::vector<FilePair>& files,
                                      const std::vector<double>& errors) {
  std::vector<EvaluationResult> out;
  for (std::size_t i = 0; i < files.size(); ++i) {
    EvaluationResult& each = out.emplace_back();
    each.estimate = files[i].estimate;
    each.drawn.reference = path(0.0, 9.0);
    each.drawn.estimate = path(0.0, 9.0, errors.empty() ? 0.1 : errors[i]);
  }
  return out;
}

std::vector<std::string> names(const DrawnRuns& sequence) {
  std::vector<std::string> out;
  for (const DrawnEvaluation& each : sequence.drawn) out.push_back(each.name);
  return out;
}

TEST(Figures, NamesAreTheShortestThatDiffer) {
  const std::vector<FilePair> files{{"t/V.csv", "ba/V/0.txt"}, {"t/V.csv", "rp/V/0.txt"}};
  const auto all = drawn_sequences(results(files, {}), labelled_runs(files, ""));
  ASSERT_THAT(all, SizeIs(1));
  EXPECT_THAT(names(all[0]), ElementsAre("ba", "rp"));
  EXPECT_STRNE(all[0].drawn[0].style.color, all[0].drawn[1].style.color);
  const std::vector<FilePair> unusual{{"t.csv", "x/a/e.txt"}, {"t.csv", "y/a/e.txt"}};
  EXPECT_THAT(names(drawn_sequences(results(unusual, {}), labelled_runs(unusual, ""))[0]),
              ElementsAre("x/a/e.txt", "y/a/e.txt"));
}

TEST(Figures, ManyRunsAreRepresentedByTheMedianOfEachMethod) {
  std::vector<FilePair> files;
  std::vector<double> errors;
  for (const char* const sequence : {"V", "W"}) {
    for (const char* const method : {"ba", "rp"}) {
      for (const int run : {0, 1, 2, 3, 4}) {
        files.push_back(
            {std::string(sequence) + ".csv",
             std::string(method) + "/" + sequence + "/" + std::to_string(run) + ".txt"});
        errors.push_back(0.1 * ((run + 2) % 5));  // the median 0.2 is run 0
      }
    }
  }
  const auto all = drawn_sequences(results(files, errors), labelled_runs(files, ""));
  ASSERT_THAT(all, SizeIs(2));
  EXPECT_EQ(all[1].sequence, "W");
  EXPECT_THAT(names(all[1]), ElementsAre("ba 0 (median)", "rp 0 (median)"));
  EXPECT_EQ(all[1].note, "8 of 10 estimates are not drawn (chosen by ATE)");
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_STREQ(all[0].drawn[i].style.color, all[1].drawn[i].style.color);
    EXPECT_EQ(all[0].drawn[i].style.dash, 1);
  }
}

TEST(Figures, ManyRunsOfOneMethodAreRepresentedByBestMedianAndWorst) {
  std::vector<FilePair> files;
  for (int run = 0; run < 7; ++run)
    files.push_back({"V.csv", "ba_" + std::to_string(run) + ".txt"});
  const auto all = drawn_sequences(results(files, {0.3, 0.1, 0.7, 0.2, 0.5, 0.6, 0.4}),
                                   labelled_runs(files, ""));
  ASSERT_THAT(all, SizeIs(1));
  EXPECT_THAT(names(all[0]), ElementsAre("ba 1 (best)", "ba 6 (median)", "ba 2 (worst)"));
}

TEST(Figures, LegendIsLimitedAndCountsTheRest) {
  PlotPanel panel;
  for (int i = 0; i < 20; ++i) {
    panel.series.push_back({"method " + std::to_string(i), "#000000", false, {{0, 0, 0}}});
  }
  const Legend legend({panel, panel}, "a note", 3.5, 8.0);
  const std::string script = legend.script(5.0);
  EXPECT_THAT(script, HasSubstr("'method 10'"));
  EXPECT_THAT(script, Not(HasSubstr("'method 11'")));
  EXPECT_THAT(script, HasSubstr("'and 9 more'"));
  EXPECT_THAT(script, HasSubstr("'a note'"));
  EXPECT_THAT(script, Not(HasSubstr("set arrow")));  // solid in SVG
  EXPECT_GT(legend.height(), 4.0 * 8.0 / 72.0);      // four rows
  EXPECT_LT(legend.height(), 8.0 * 1.5 * 8.0 / 72.0);
}

TEST(Figures, EvalFiguresAreOneColumnWideUnlessASizeIsGiven) {
  if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "needs gnuplot";
  const TemporaryFolder folder;
  write_tum(folder.path() / "gt.txt", path(0.0, 50.0));
  write_tum(folder.path() / "est.txt", path(5.0, 50.0, 0.1));
  const auto svg = [&](const std::string& name) { return read_all(folder.path() / name); };
  const std::string eval = "eval gt.txt est.txt --align none ";
  const CommandResult usual = loopbench_command(eval + "--plot a", folder);
  ASSERT_EQ(usual.exit_code, 0) << usual.err;
  EXPECT_THAT(usual.err, Not(HasSubstr("arning"))) << usual.err;
  for (const char* const name : {"a_trajectories.svg", "a_errors.svg", "a_axes.svg"}) {
    EXPECT_THAT(svg(name), HasSubstr("width=\"252\"")) << name;  // 3.5 in of 72 points
  }
  const CommandResult sized =
      loopbench_command(eval + "--plot b --size 2,1.5 --columns 3 --font 9", folder);
  ASSERT_EQ(sized.exit_code, 0) << sized.err;
  EXPECT_THAT(svg("b_errors.svg"), HasSubstr("width=\"432\""));
  EXPECT_THAT(svg("b_errors.svg"), HasSubstr("font-size=\"9.00\""));
  EXPECT_EQ(loopbench_command(eval + "--size 2,1.5", folder).exit_code, 2);
}

}  // namespace
}  // namespace loopbench::figures_test
