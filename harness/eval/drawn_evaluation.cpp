#include "harness/eval/drawn_evaluation.hpp"

#include <algorithm>
#include <cmath>

#include "metrics/trajectory/projection.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostReferencePoses = 1000;  // more are not visible

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

}  // namespace

DrawnEvaluation drawn_evaluation(const Trajectory& reference,
                                 const metrics::Evaluation& evaluation) {
  DrawnEvaluation out;
  out.reference = evaluation.reference;
  out.estimate = evaluation.estimate;
  Trajectory complete = reference;
  metrics::project(complete, evaluation.protocol.project);
  const std::vector<double> lengths = path_lengths(complete);
  const double origin = complete.front().stamp;
  for (const StampedPose& pose : out.reference) {
    out.times.push_back(pose.stamp - origin);
    out.distances.push_back(length_at(pose.stamp, complete, lengths));
  }
  const std::size_t step = complete.size() / kMostReferencePoses + 1;
  for (std::size_t i = 0; i < complete.size(); i += step) out.complete.push_back(complete[i]);
  if ((complete.size() - 1) % step != 0) out.complete.push_back(complete.back());
  for (StampedPose& pose : out.complete) pose.stamp -= origin;
  return out;
}

double position_rmse(const DrawnEvaluation& drawn) {
  double sum = 0.0;
  for (std::size_t i = 0; i < drawn.estimate.size(); ++i) {
    sum += (drawn.estimate[i].world_from_body.translation -
            drawn.reference[i].world_from_body.translation)
               .squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, drawn.estimate.size())));
}

}  // namespace loopbench::harness
