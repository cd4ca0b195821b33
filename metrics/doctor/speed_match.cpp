#include "metrics/doctor/speed_match.hpp"

#include <algorithm>
#include <cmath>

#include "datasets/core/interpolate.hpp"
#include "metrics/doctor/agreement.hpp"

namespace loopbench::metrics {

SpeedMatch::SpeedMatch(const Trajectory& reference, const Trajectory& estimate, Part part)
    : reference_(reference) {
  constexpr std::size_t kMostPairs = 600;
  constexpr double kShortest = 0.1, kLongest = 10.0;  // [s]; of intervals
  constexpr double kRounding = 0.99;
  const double usual = usual_interval(reference);
  interval_ = kRounding * std::max({kShortest, usual, usual_interval(estimate)});
  longest_gap_ = std::max(1.0, 10.0 * usual);
  const std::size_t step = std::max<std::size_t>(1, estimate.size() / kMostPairs);
  std::size_t j = 0;
  for (std::size_t i = 0; i < estimate.size(); i = std::max(j, i + step)) {
    j = first_from(estimate, estimate[i].stamp + interval_, i + 1);
    if (j == estimate.size()) break;
    const double duration = estimate[j].stamp - estimate[i].stamp;
    if (duration > kLongest * interval_) continue;
    const Pose& from = estimate[i].world_from_body;
    const Pose& to = estimate[j].world_from_body;
    speeds_.push_back({estimate[i].stamp,
                       estimate[j].stamp,
                       angle_between(from.rotation, to.rotation) / duration,
                       (to.translation - from.translation).norm() / duration});
  }
  if (part == Part::all) return;
  const std::size_t n = speeds_.size();
  std::vector<TimedSpeed> kept;
  for (std::size_t i = 0; i < n; ++i) {
    if (is_fitted(i, n) == (part == Part::fitted)) kept.push_back(speeds_[i]);
  }
  speeds_ = std::move(kept);
}

double SpeedMatch::Score::best() const {
  constexpr double kPenalty = 0.15;
  if (!is_known) return -1.0;
  return std::max({0.5 * (angle + distance), angle - kPenalty, distance - kPenalty});
}

SpeedMatch::Score SpeedMatch::score(double offset) const {
  constexpr std::size_t kFewest = 10;
  std::vector<double> reference_angle, estimate_angle, reference_distance, estimate_distance;
  std::size_t hint = 0;
  for (const TimedSpeed& speed : speeds_) {
    const std::optional<Pose> from = reference_at(speed.begin + offset, hint);
    const std::optional<Pose> to = reference_at(speed.end + offset, hint);
    if (!from || !to) continue;
    const double duration = speed.end - speed.begin;
    reference_angle.push_back(angle_between(from->rotation, to->rotation) / duration);
    estimate_angle.push_back(speed.angle);
    reference_distance.push_back((to->translation - from->translation).norm() / duration);
    estimate_distance.push_back(speed.distance);
  }
  if (reference_angle.size() < std::max(kFewest, speeds_.size() / 5)) return {};
  return {correlation(reference_angle, estimate_angle),
          correlation(reference_distance, estimate_distance),
          true};
}

std::optional<Pose> SpeedMatch::reference_at(double stamp, std::size_t& hint) const {
  if (reference_.empty() || !(stamp >= reference_.front().stamp)) return std::nullopt;
  hint = first_from(reference_, stamp, hint);
  if (hint == reference_.size()) return std::nullopt;
  const StampedPose& after = reference_[hint];
  if (after.stamp == stamp) return after.world_from_body;
  const StampedPose& before = reference_[hint - 1];
  const double gap = after.stamp - before.stamp;
  if (gap > longest_gap_) return std::nullopt;
  return interpolate(before.world_from_body, after.world_from_body, (stamp - before.stamp) / gap);
}

}  // namespace loopbench::metrics
