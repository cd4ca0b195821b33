#include "harness/commands/eval/eval_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "harness/answers/report/alignment_text.hpp"
#include "harness/sweep/model/name_order.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/trajectory/projection.hpp"

namespace loopbench::harness {
namespace {

/// Adds the columns of a trajectory.
DrawnCurve drawn_trajectory(DrawnCurve out, const Trajectory& poses, double origin) {
  add_poses(out, poses, origin);
  if (poses.size() > 1) {
    out.peaks = {"speed"};
    std::vector<double>& speed = out.columns["speed"];
    for (std::size_t i = 1; i < poses.size(); ++i) {
      const Vector3 step =
          poses[i].world_from_body.translation - poses[i - 1].world_from_body.translation;
      speed.push_back(step.norm() / (poses[i].stamp - poses[i - 1].stamp));
    }
    speed.insert(speed.begin(), speed.front());
  }
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

/// Leaves the reference and the kMostEstimates curves with the smallest errors, in their order.
/// Returns the number of the others.
std::size_t keep_best(std::vector<DrawnCurve>& curves) {
  if (curves.size() <= 1 + kMostEstimates) return 0;
  std::vector<double> errors;
  for (const DrawnCurve& curve : curves) errors.push_back(curve.rmse.value_or(0.0));
  std::vector<double> sorted = errors;  // the reference's is first
  std::ranges::nth_element(sorted, sorted.begin() + kMostEstimates);
  const double most = sorted[kMostEstimates];
  std::vector<DrawnCurve> kept;
  for (std::size_t i = 0; i < curves.size() && kept.size() <= kMostEstimates; ++i) {
    if (i == 0 || errors[i] <= most) kept.push_back(std::move(curves[i]));
  }
  const std::size_t left_out = curves.size() - kept.size();
  curves = std::move(kept);
  return left_out;
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
                      const std::vector<EvaluatedRun>& runs) {
  FigureData out;
  NameOrder methods;
  std::map<std::string, std::size_t> count, before;  // by method
  for (const EvaluatedRun& run : runs) {
    methods.index(run.method);
    ++count[run.method];
  }
  const bool is_several = methods.names().size() > 1;
  const std::size_t protocols = runs.empty() ? 1 : all.size() / runs.size();
  for (std::size_t i = 0; i < all.size(); i += protocols) {
    const EvaluatedRun& run = runs[i / protocols];
    if (!all[i].why_failed.empty()) continue;
    const std::size_t repeat = before[run.method]++;
    if (out.curves.empty()) {
      out.title = run.sequence + ", " + alignment_text(to_text(all[i].alignment.type)) +
                  ". In brackets: position error (RMSE)";
      out.curves.push_back(all[i].drawn.front());
    }
    DrawnCurve& curve = out.curves.emplace_back(all[i].drawn.back());
    const bool has_repeats = count[run.method] > 1;
    curve.name = run.method + (has_repeats ? " " + run.run : "");
    curve.style = is_several ? methods.index(run.method) : repeat;
    if (is_several && has_repeats) curve.dash = 1 + static_cast<int>(repeat % 5);
  }
  const std::size_t left_out = keep_best(out.curves);
  if (left_out > 0) {
    out.note = fmt::format(
        "the best {} of {} estimates are drawn", kMostEstimates, kMostEstimates + left_out);
  }
  return out;
}

DrawnFigure evaluation_page(const std::filesystem::path& name) {
  return {{figure_name(name)},
          {"plane",
           "xyz",
           "error by time",
           "angle by time",
           "histogram",
           "boxes",
           "x by time",
           "y by time",
           "z by time",
           "roll by time",
           "pitch by time",
           "yaw by time"},
          {.size = {2.4, 2.1}, .columns = 3, .font = 7.0}};
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
    out.title = alignment_text("none");
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
