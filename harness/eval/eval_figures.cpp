#include "harness/eval/eval_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "harness/model/name_order.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/trajectory/projection.hpp"

namespace loopbench::harness {
namespace {

/// A candidate for a figure.
struct RatedRun {
  DrawnCurve curve;
  std::string method;
  bool is_complete = true;
};

/// Best, median and worst of runs of one method, or only the median.
std::vector<DrawnCurve> representative(std::vector<RatedRun> runs, bool is_only) {
  std::ranges::stable_sort(runs, {}, [](const RatedRun& run) { return run.curve.rmse; });
  const auto named = [&](std::size_t i, const char* role) {
    DrawnCurve out = runs[i].curve;
    out.name += role;
    out.dash = 0;  // no other run of its method has its colour
    return out;
  };
  const std::size_t middle = (runs.size() - 1) / 2;
  if (runs.size() == 1) return {named(0, "")};
  if (!is_only) return {named(middle, " (median)")};
  std::vector<DrawnCurve> out{
      named(0, " (best)"), named(middle, " (median)"), named(runs.size() - 1, " (worst)")};
  for (std::size_t i = 0; i < out.size(); ++i) out[i].style = i;
  return out;
}

/// Adds curves to the one of the reference.
void choose_drawn(const std::vector<RatedRun>& all, FigureData& out) {
  if (all.size() <= kMostDrawnEstimates) {
    for (const RatedRun& each : all) out.curves.push_back(each.curve);
    return;
  }
  std::vector<std::string> methods;
  std::map<std::string, std::vector<RatedRun>> runs;
  const bool has_complete = std::ranges::any_of(all, &RatedRun::is_complete);
  for (const RatedRun& each : all) {
    if (has_complete && !each.is_complete) continue;
    if (runs[each.method].empty()) methods.push_back(each.method);
    runs[each.method].push_back(each);
  }
  const bool is_only = methods.size() == 1 && runs[methods.front()].size() > 2;
  const bool has_repeats = runs.size() < all.size();
  if (methods.size() > kMostDrawnEstimates) methods.resize(kMostDrawnEstimates);
  for (const std::string& method : methods) {
    std::ranges::move(representative(runs[method], is_only), std::back_inserter(out.curves));
  }
  out.note = fmt::format("{} of {} estimates are not drawn{}",
                         all.size() + 1 - out.curves.size(),
                         all.size(),
                         has_repeats ? " (chosen by ATE)" : "");
}

/// Adds the columns of a trajectory.
DrawnCurve drawn_trajectory(DrawnCurve out, const Trajectory& poses, double origin) {
  add_poses(out, poses, origin);
  std::vector<std::string> peaks;
  if (poses.size() > 1) {
    peaks = {"speed"};
    std::vector<double>& speed = out.columns["speed"];
    for (std::size_t i = 1; i < poses.size(); ++i) {
      const Vector3 step =
          poses[i].world_from_body.translation - poses[i - 1].world_from_body.translation;
      speed.push_back(step.norm() / (poses[i].stamp - poses[i - 1].stamp));
    }
    speed.insert(speed.begin(), speed.front());
  }
  thin(out, peaks);
  return out;
}

std::vector<std::string> short_names(const std::vector<NamedTrajectory>& all) {
  std::vector<std::string> stems, names;
  for (const NamedTrajectory& each : all) {
    names.push_back(each.name);
    stems.push_back(output_stem(each.name));
  }
  return std::set(stems.begin(), stems.end()).size() == all.size() ? stems : names;
}

}  // namespace

std::vector<DrawnCurve> drawn_evaluation(const Trajectory& reference,
                                         const metrics::Evaluation& evaluation) {
  Trajectory complete = reference;
  metrics::project(complete, evaluation.protocol.project);
  const double origin = complete.front().stamp;
  DrawnCurve expected_curve = reference_curve(), out;
  add_poses(expected_curve, complete, origin);
  thin(expected_curve);

  add_poses(out, evaluation.estimate, origin);
  auto& columns = out.columns;
  double sum = 0.0;
  const bool has_angles = metrics::why_no_attitude(evaluation).empty();
  columns["time"].clear();  // stamps of the pairs are those of the reference
  for (std::size_t i = 0; i < evaluation.estimate.size(); ++i) {
    const Pose& expected = evaluation.reference[i].world_from_body;
    const Pose& found = evaluation.estimate[i].world_from_body;
    columns["time"].push_back(evaluation.reference[i].stamp - origin);
    columns["error"].push_back((found.translation - expected.translation).norm());
    if (has_angles) {
      columns["angle"].push_back(metrics::kDegrees *
                                 angle_between(found.rotation, expected.rotation));
    }
    sum += columns["error"].back() * columns["error"].back();
  }
  const auto count = static_cast<double>(std::max<std::size_t>(1, evaluation.estimate.size()));
  out.rmse = std::sqrt(sum / count);
  std::vector<double> sorted = columns["error"];
  std::ranges::sort(sorted);
  thin(out,
       has_angles ? std::vector<std::string>{"error", "angle"} : std::vector<std::string>{"error"});
  for (const std::size_t i : subsampled_indices(sorted.size(), kMostRows)) {
    columns["sorted_errors"].push_back(sorted[i]);
  }
  return {std::move(expected_curve), std::move(out)};
}

FigureData drawn_runs(const std::vector<EvaluationResult>& all,
                      const std::vector<RecordedRun>& runs) {
  FigureData out;
  NameOrder methods;
  std::map<std::string, std::size_t> count, before;  // by method
  for (const RecordedRun& run : runs) {
    methods.index(run.method);
    ++count[run.method];
  }
  const std::size_t protocols = runs.empty() ? 1 : all.size() / runs.size();
  std::vector<RatedRun> candidates;
  for (std::size_t i = 0; i < all.size(); i += protocols) {
    const RecordedRun& run = runs[i / protocols];
    const std::size_t repeat = before[run.method]++;
    if (!all[i].why_failed.empty()) continue;
    if (candidates.empty()) {
      const metrics::Align align = all[i].alignment.type;
      const std::string how = align == metrics::Align::none ? "no" : to_text(align);
      out.title = run.sequence + ", " + how + " alignment (ATE as RMSE)";
      out.curves.push_back(all[i].drawn.front());
    }
    candidates.push_back({all[i].drawn.back(), run.method, all[i].incomplete_reason.empty()});
    DrawnCurve& curve = candidates.back().curve;
    const bool has_repeats = count[run.method] > 1;
    curve.name = run.method + (has_repeats ? " " + run.run : "");
    curve.style = methods.names().size() > 1 ? methods.index(run.method) : repeat;
    if (methods.names().size() > 1 && has_repeats) curve.dash = 1 + static_cast<int>(repeat % 5);
  }
  choose_drawn(candidates, out);
  return out;
}

std::vector<DrawnFigure> figures_for_paper(std::filesystem::path name,
                                           const FigureOptions& options) {
  constexpr double kColumnWidth = 3.5;                  // of a paper [in]
  constexpr double kMapShape = 0.9, kCurveShape = 0.4;  // height over width
  const std::vector<std::string> panels[kErrorFigures.size()] = {
      {"plane", "xyz"},
      {"error by time", "angle by time", "histogram", "boxes"},
      {"x by time", "y by time", "z by time", "roll by time", "pitch by time", "yaw by time"}};
  std::vector<DrawnFigure> out;
  if (!is_figure_name(name)) {
    DrawnFigure& page = out.emplace_back(DrawnFigure{{figure_name(name)}, {}, options});
    for (const auto& some : panels) page.panels.insert(page.panels.end(), some.begin(), some.end());
    page.options.columns = 3;
    page.options.size = {2.4, 2.1};
    page.options.font = 7.0;
    return out;
  }
  const std::string suffix = name.extension().string();
  const std::string prefix = name.replace_extension().string();
  for (std::size_t i = 0; i < kErrorFigures.size(); ++i) {
    const bool is_map = i == 0;
    DrawnFigure& figure = out.emplace_back(DrawnFigure{{}, panels[i], options});
    const std::size_t columns = is_map ? 2 : 1;
    const double width = kColumnWidth / static_cast<double>(columns);
    figure.options.columns = columns;
    figure.options.size = {width, width * (is_map ? kMapShape : kCurveShape)};
    figure.options.font = 7.0;
    figure.files.emplace_back(prefix + "_" + kErrorFigures[i] + suffix);
  }
  return out;
}

FigureData trajectory_figure(const std::vector<NamedTrajectory>& all,
                             const std::optional<NamedTrajectory>& reference,
                             const std::vector<std::string>& panels,
                             const FigureOptions& options) {
  double origin =
      reference ? reference->file.poses.front().stamp : all.front().file.poses.front().stamp;
  for (const NamedTrajectory& each : all) {
    if (!reference) origin = std::min(origin, each.file.poses.front().stamp);
  }
  FigureData out;
  if (reference) {
    out.curves.push_back(drawn_trajectory(reference_curve(), reference->file.poses, origin));
    out.title = "no alignment";
  }
  const std::vector<std::string> names = labels_of(options, short_names(all));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const DrawnCurve curve{.name = names[i], .style = i};
    out.curves.push_back(drawn_trajectory(curve, all[i].file.poses, origin));
  }
  DrawnFigure& figure = out.figures.emplace_back(DrawnFigure{{}, {}, options});
  if (!options.columns) figure.options.columns = 3;
  for (const std::string& panel : panels) {
    const bool is_map = panel == "plane" || panel.find_first_not_of("xyz") == std::string::npos;
    figure.panels.push_back(is_map && panel.size() > 1 ? panel : panel + " by time");
  }
  return out;
}

}  // namespace loopbench::harness
