#include "harness/eval/drawn_evaluation.hpp"

#include <algorithm>
#include <cmath>

#include "metrics/numerics/angle.hpp"
#include "metrics/trajectory/projection.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostRowsOfErrors =
    1000;  // of a curve, without its peaks; more are not visible

std::vector<double> path_lengths(const Trajectory& poses) {
  std::vector<double> out(poses.size(), 0.0);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    out[i] =
        out[i - 1] +
        (poses[i].world_from_body.translation - poses[i - 1].world_from_body.translation).norm();
  }
  return out;
}

/// Path length at a stamp, which interpolated associations place between two poses.
double length_at(double stamp, const Trajectory& poses, const std::vector<double>& lengths) {
  const auto after = std::ranges::upper_bound(poses, stamp, {}, &StampedPose::stamp);
  if (after == poses.begin()) return 0.0;
  if (after == poses.end()) return lengths.back();
  const auto i = static_cast<std::size_t>(after - poses.begin());
  const double share = (stamp - poses[i - 1].stamp) / (poses[i].stamp - poses[i - 1].stamp);
  return lengths[i - 1] + share * (lengths[i] - lengths[i - 1]);
}

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

}  // namespace

DrawnEvaluation drawn_evaluation(const Trajectory& reference,
                                 const metrics::Evaluation& evaluation) {
  Trajectory complete = reference;
  metrics::project(complete, evaluation.protocol.project);
  const std::vector<double> lengths = path_lengths(complete);
  const double origin = complete.front().stamp;
  DrawnEvaluation out{{}, reference_curve(), 0.0};
  add_poses(out.reference, complete, origin);
  thin(out.reference, kMostRowsOfErrors);

  add_poses(out.estimate, evaluation.estimate, origin);
  auto& columns = out.estimate.columns;
  columns["time"].clear();  // stamps of the pairs are those of the reference
  for (std::size_t i = 0; i < evaluation.estimate.size(); ++i) {
    const Pose& expected = evaluation.reference[i].world_from_body;
    const Pose& found = evaluation.estimate[i].world_from_body;
    columns["time"].push_back(evaluation.reference[i].stamp - origin);
    columns["distance"].push_back(length_at(evaluation.reference[i].stamp, complete, lengths));
    columns["error"].push_back((found.translation - expected.translation).norm());
    columns["angle"].push_back(metrics::kDegrees *
                               angle_between(found.rotation, expected.rotation));
    out.position_rmse += columns["error"].back() * columns["error"].back();
  }
  const auto count = static_cast<double>(std::max<std::size_t>(1, evaluation.estimate.size()));
  out.position_rmse = std::sqrt(out.position_rmse / count);
  std::vector<double> errors = sorted_values(columns["error"]);
  thin(out.estimate, kMostRowsOfErrors, {"error", "angle"});
  columns["sorted_errors"] = std::move(errors);
  return out;
}

}  // namespace loopbench::harness
