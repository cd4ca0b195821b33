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
  const double usual = usual_interval(reference);
  interval_ = std::max({kShortest, usual, 0.99 * usual_interval(estimate)});
  longest_gap_ = std::max(1.0, 10.0 * usual);
  const std::size_t step = std::max<std::size_t>(1, estimate.size() / kMostPairs);
  const double whole = reference.empty() ? 0.0 : reference.back().stamp - reference[0].stamp;
  if (whole > 0.0) rate_ = static_cast<double>(reference.size() - 1) / whole;
  std::size_t j = 0;
  for (std::size_t i = 0; i < estimate.size(); i = std::max(j, i + step)) {
    j = std::max(j, i);
    const auto is_short = [&](std::size_t k) {  // the sum below is rounded
      return estimate[k].stamp - estimate[i].stamp < interval_;
    };
    j = std::max(j, first_from(estimate, estimate[i].stamp + interval_, j));
    while (j > i && !is_short(j - 1)) --j;
    while (j < estimate.size() && is_short(j)) ++j;
    if (j == estimate.size()) break;
    const double duration = estimate[j].stamp - estimate[i].stamp;
    if (duration > kLongest * interval_) continue;
    const Pose& from = estimate[i].world_from_body;
    const Pose& to = estimate[j].world_from_body;
    motions_.push_back({estimate[i].stamp,
                        estimate[j].stamp,
                        angle_between(from.rotation, to.rotation),
                        (to.translation - from.translation).norm()});
  }
  if (part == Part::all) return;
  const std::size_t n = motions_.size();
  std::vector<TimedMotion> kept;
  for (std::size_t i = 0; i < n; ++i) {
    if (is_fitted(i, n) == (part == Part::fitted)) kept.push_back(motions_[i]);
  }
  motions_ = std::move(kept);
}

MotionSignals SpeedMatch::signals(double offset) const {
  MotionSignals out;
  for (const TimedMotion& motion : motions_) {
    const std::optional<Pose> from = reference_at(motion.begin + offset);
    const std::optional<Pose> to = reference_at(motion.end + offset);
    if (!from || !to) continue;
    out.reference_angle.push_back(angle_between(from->rotation, to->rotation));
    out.estimate_angle.push_back(motion.angle);
    out.reference_distance.push_back((to->translation - from->translation).norm());
    out.estimate_distance.push_back(motion.distance);
    out.duration.push_back(motion.end - motion.begin);
  }
  return out;
}

double SpeedMatch::Score::best() const {
  constexpr double kPenalty = 0.15;
  if (!is_known) return -1.0;
  return std::max({0.5 * (angle + distance), angle - kPenalty, distance - kPenalty});
}

SpeedMatch::Score SpeedMatch::score_of_speeds(double offset) const {
  MotionSignals s = signals(offset);
  for (auto* values :
       {&s.reference_angle, &s.estimate_angle, &s.reference_distance, &s.estimate_distance}) {
    for (std::size_t i = 0; i < values->size(); ++i) (*values)[i] /= s.duration[i];
  }
  return score(s);
}

SpeedMatch::Score SpeedMatch::score(const MotionSignals& s) const {
  constexpr std::size_t kFewest = 10;
  if (s.reference_angle.size() < std::max(kFewest, motions_.size() / 5)) return {};
  return {correlation(s.reference_angle, s.estimate_angle),
          correlation(s.reference_distance, s.estimate_distance),
          true};
}

std::optional<Pose> SpeedMatch::reference_at(double stamp) const {
  if (reference_.empty() || !(stamp >= reference_.front().stamp)) return std::nullopt;
  // Poses are close to evenly spaced, so the search begins near its result.
  const double expected =
      std::min(rate_ * (stamp - reference_.front().stamp), static_cast<double>(reference_.size()));
  const std::size_t index = first_from(reference_, stamp, static_cast<std::size_t>(expected));
  if (index == reference_.size()) return std::nullopt;
  const StampedPose& after = reference_[index];
  if (after.stamp == stamp) return after.world_from_body;
  const StampedPose& before = reference_[index - 1];
  const double gap = after.stamp - before.stamp;
  if (gap > longest_gap_) return std::nullopt;
  return interpolate(before.world_from_body, after.world_from_body, (stamp - before.stamp) / gap);
}

}  // namespace loopbench::metrics
