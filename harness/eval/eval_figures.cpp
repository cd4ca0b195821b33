#include "harness/eval/eval_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "harness/model/name_order.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/trajectory/projection.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostRowsOfErrors =
    1000;  // of a curve, without its peaks; more are not visible

/// At most kMostRowsOfErrors values of equal distance in rank.
std::vector<double> sorted_values(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t kept = std::min(values.size(), kMostRowsOfErrors);
  std::vector<double> out(kept);
  for (std::size_t i = 0; i < kept; ++i) {
    out[i] = values[kept == 1 ? 0 : i * (values.size() - 1) / (kept - 1)];
  }
  return out;
}

/// A candidate for a figure.
struct RatedRun {
  DrawnEvaluation drawn;
  std::string method;
  bool is_complete = true;
  double ate() const { return drawn.position_rmse; }  ///< [m]
};

/// Best, median and worst of runs of one method, or only the median.
std::vector<DrawnEvaluation> representative(std::vector<RatedRun> runs, bool is_only) {
  std::ranges::stable_sort(runs, {}, &RatedRun::ate);
  const auto named = [&](std::size_t i, const char* role) {
    DrawnEvaluation out = runs[i].drawn;
    out.estimate.name += role;
    out.estimate.dash = 0;  // no other run of its method has its colour
    return out;
  };
  const std::size_t middle = (runs.size() - 1) / 2;
  if (runs.size() == 1) return {named(0, "")};
  if (!is_only) return {named(middle, " (median)")};
  std::vector<DrawnEvaluation> out{
      named(0, " (best)"), named(middle, " (median)"), named(runs.size() - 1, " (worst)")};
  for (std::size_t i = 0; i < out.size(); ++i) out[i].estimate.style = i;
  return out;
}

void choose_drawn(const std::vector<RatedRun>& all, DrawnRuns& out) {
  if (all.size() <= kMostDrawnEstimates) {
    for (const RatedRun& each : all) out.drawn.push_back(each.drawn);
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
    std::ranges::move(representative(runs[method], is_only), std::back_inserter(out.drawn));
  }
  out.note = fmt::format("{} of {} estimates are not drawn{}",
                         all.size() - out.drawn.size(),
                         all.size(),
                         has_repeats ? " (chosen by ATE)" : "");
}

/// Of each of kErrorFigures.
const std::array<std::vector<std::string>, kErrorFigures.size()>& panels() {
  static const std::array<std::vector<std::string>, kErrorFigures.size()> all{
      {{"plane", "xyz"},
       {"error by time", "angle by time", "histogram", "boxes"},
       {"x by time", "y by time", "z by time", "roll by time", "pitch by time", "yaw by time"}}};
  return all;
}

}  // namespace

DrawnEvaluation drawn_evaluation(const Trajectory& reference,
                                 const metrics::Evaluation& evaluation) {
  Trajectory complete = reference;
  metrics::project(complete, evaluation.protocol.project);
  const double origin = complete.front().stamp;
  DrawnEvaluation out{{}, reference_curve(), 0.0};
  add_poses(out.reference, complete, origin);
  thin(out.reference, kMostRowsOfErrors);

  add_poses(out.estimate, evaluation.estimate, origin);
  auto& columns = out.estimate.columns;
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
    out.position_rmse += columns["error"].back() * columns["error"].back();
  }
  const auto count = static_cast<double>(std::max<std::size_t>(1, evaluation.estimate.size()));
  out.position_rmse = std::sqrt(out.position_rmse / count);
  std::vector<double> errors = sorted_values(columns["error"]);
  thin(out.estimate,
       kMostRowsOfErrors,
       has_angles ? std::vector<std::string>{"error", "angle"} : std::vector<std::string>{"error"});
  columns["sorted_errors"] = std::move(errors);
  return out;
}

DrawnRuns drawn_runs(const std::vector<EvaluationResult>& all,
                     const std::vector<RecordedRun>& runs) {
  DrawnRuns out;
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
    }
    RatedRun& candidate = candidates.emplace_back(
        RatedRun{all[i].drawn, run.method, all[i].incomplete_reason.empty()});
    DrawnCurve& curve = candidate.drawn.estimate;
    const bool has_repeats = count[run.method] > 1;
    curve.name = run.method + (has_repeats ? " " + run.run : "");
    curve.style = methods.names().size() > 1 ? methods.index(run.method) : repeat;
    if (methods.names().size() > 1 && has_repeats) curve.dash = 1 + static_cast<int>(repeat % 5);
  }
  choose_drawn(candidates, out);
  return out;
}

FigureData figure_data(const DrawnRuns& runs) {
  FigureData out{runs.title, runs.note, {}, {}};
  if (!runs.drawn.empty()) out.curves.push_back(runs.drawn.front().reference);
  for (const DrawnEvaluation& each : runs.drawn) {
    out.curves.push_back(each.estimate);
    out.curves.back().rmse = each.position_rmse;
  }
  return out;
}

std::vector<DrawnFigure> figures_for_paper(const std::string& prefix,
                                           const std::vector<std::string>& suffixes,
                                           const FigureOptions& options) {
  constexpr double kColumnWidth = 3.5;                  // of a paper [in]
  constexpr double kMapShape = 0.9, kCurveShape = 0.4;  // height over width
  std::vector<DrawnFigure> out;
  for (std::size_t i = 0; i < kErrorFigures.size(); ++i) {
    const bool is_map = i == 0;
    DrawnFigure& figure = out.emplace_back(DrawnFigure{{}, panels()[i], options});
    const std::size_t columns = is_map ? 2 : 1;
    const double width = kColumnWidth / static_cast<double>(columns);
    figure.options.columns = columns;
    figure.options.size = {width, width * (is_map ? kMapShape : kCurveShape)};
    figure.options.font = 7.0;
    for (const std::string& suffix : suffixes) {
      figure.files.emplace_back(prefix + "_" + kErrorFigures[i] + suffix);
    }
  }
  return out;
}

}  // namespace loopbench::harness
