#include "metrics/doctor/time_offset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/core/interpolate.hpp"
#include "metrics/doctor/common_motion.hpp"

namespace loopbench::metrics {
namespace {

constexpr std::size_t kMostPairs = 600;
constexpr double kSearch = 10.0;  // [s]

/// Motion of the estimate between two of its stamps.
struct TimedMotion {
  double begin = 0.0;
  double end = 0.0;
  double angle = 0.0;
  double distance = 0.0;
};

/// 0 without rotations: then the offset is found by the distances alone.
double angle_of(const Pose& from, const Pose& to) {
  return has_rotation(from) ? angle_between(from.rotation, to.rotation) : 0.0;
}

/// Correlation of speeds for offsets between two trajectories, over at most kMostPairs intervals
/// that do not overlap.
class SpeedMatch {
 public:
  SpeedMatch(const Trajectory& reference, const Trajectory& estimate) : reference_(reference) {
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
                          angle_of(from, to),
                          (to.translation - from.translation).norm()});
    }
  }

  double interval() const { return interval_; }

  MotionSignals signals(double offset) const { return signals(offset, offset, 0.0); }

  /// Only intervals that are known at all offsets within `margin` of `centre`, so that the lists
  /// for these offsets have the same intervals.
  MotionSignals signals(double offset, double centre, double margin) const {
    MotionSignals out;
    for (const TimedMotion& motion : motions_) {
      const bool is_known = margin == 0.0 || (reference_at(motion.begin + centre - margin) &&
                                              reference_at(motion.begin + centre + margin) &&
                                              reference_at(motion.end + centre - margin) &&
                                              reference_at(motion.end + centre + margin));
      if (!is_known) continue;
      const std::optional<Pose> from = reference_at(motion.begin + offset);
      const std::optional<Pose> to = reference_at(motion.end + offset);
      if (!from || !to) continue;
      out.reference_angle.push_back(angle_of(*from, *to));
      out.estimate_angle.push_back(motion.angle);
      out.reference_distance.push_back((to->translation - from->translation).norm());
      out.estimate_distance.push_back(motion.distance);
      out.duration.push_back(motion.end - motion.begin);
    }
    return out;
  }

  struct Score {
    double angle = 0.0;
    double distance = 0.0;
    bool is_known = false;  ///< at least a fifth of the intervals are common

    /// One of the speeds is enough: a vehicle at constant speed, a drifting scale.
    double best() const {
      constexpr double kPenalty = 0.15;
      if (!is_known) return -1.0;
      return std::max({0.5 * (angle + distance), angle - kPenalty, distance - kPenalty});
    }
  };

  Score score(double offset) const { return score(signals(offset)); }

  /// Of speeds instead of steps: at constant speeds, steps correlate at any offset if the durations
  /// of intervals differ.
  Score score_of_speeds(double offset) const {
    MotionSignals s = signals(offset);
    for (auto* values :
         {&s.reference_angle, &s.estimate_angle, &s.reference_distance, &s.estimate_distance}) {
      for (std::size_t i = 0; i < values->size(); ++i) (*values)[i] /= s.duration[i];
    }
    return score(s);
  }

  double at(double offset) const { return score(offset).best(); }

 private:
  Score score(const MotionSignals& s) const {
    constexpr std::size_t kFewest = 10;
    if (s.reference_angle.size() < std::max(kFewest, motions_.size() / 5)) return {};
    return {correlation(s.reference_angle, s.estimate_angle),
            correlation(s.reference_distance, s.estimate_distance),
            true};
  }

  std::optional<Pose> reference_at(double stamp) const {
    if (reference_.empty() || !(stamp >= reference_.front().stamp)) return std::nullopt;
    // Poses are close to evenly spaced, so the search begins near its result.
    const double expected = std::min(rate_ * (stamp - reference_.front().stamp),
                                     static_cast<double>(reference_.size()));
    const std::size_t index = first_from(reference_, stamp, static_cast<std::size_t>(expected));
    if (index == reference_.size()) return std::nullopt;
    const StampedPose& after = reference_[index];
    if (after.stamp == stamp) return after.world_from_body;
    const StampedPose& before = reference_[index - 1];
    const double gap = after.stamp - before.stamp;
    if (gap > longest_gap_) return std::nullopt;
    return interpolate(before.world_from_body, after.world_from_body, (stamp - before.stamp) / gap);
  }

  const Trajectory& reference_;
  std::vector<TimedMotion> motions_;
  double interval_ = 0.0;
  double rate_ = 0.0;  ///< poses of the reference per second
  double longest_gap_ = 0.0;
};

struct Best {
  double offset = 0.0;
  double score = -1.0;
};

Best search(const SpeedMatch& match, double low, double high, double step) {
  Best best;
  for (double offset = low; offset <= high + 1e-9; offset += step) {
    const double score = match.at(offset);
    if (score > best.score) best = {offset, score};
  }
  return best;
}

/// Periodic speeds fit equally well at several offsets; of these, the one near zero is the likely
/// one.
Best nearest_of_equal(const SpeedMatch& match, const Best& best, double step) {
  constexpr double kNear = 1.0;  // [s]
  if (std::abs(best.offset) <= kNear) return best;
  const Best refined = search(match, best.offset - 5.0 * step, best.offset + 5.0 * step, step);
  const Best near = search(match, -kNear, kNear, step);
  const double least_gain = std::max(0.003, 0.1 * (1.0 - refined.score));
  return near.score > refined.score - least_gain ? near : refined;
}

/// Vertex of the parabola through three scores.
double vertex(const SpeedMatch& match, double offset, double step) {
  const double left = match.at(offset - step);
  const double middle = match.at(offset);
  const double right = match.at(offset + step);
  const double curvature = left - 2.0 * middle + right;
  if (!(curvature < 0.0)) return offset;
  return offset + std::clamp(0.5 * step * (left - right) / curvature, -step, step);
}

/// Standard deviation of the offset in least squares of the angles and of the distances.
double deviation_of(const SpeedMatch& match, double offset, double step) {
  const MotionSignals here = match.signals(offset, offset, step);
  const MotionSignals after = match.signals(offset + step, offset, step);
  const MotionSignals before = match.signals(offset - step, offset, step);
  double information = 0.0;
  const auto add = [&](const std::vector<double>& reference,
                       const std::vector<double>& estimate,
                       const std::vector<double>& later,
                       const std::vector<double>& earlier) {
    if (later.size() != reference.size() || earlier.size() != reference.size()) return;
    double rr = 0.0, re = 0.0, slopes = 0.0, residuals = 0.0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
      rr += reference[i] * reference[i];
      re += reference[i] * estimate[i];
    }
    const double ratio = rr > 0.0 ? re / rr : 0.0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
      const double slope = ratio * (later[i] - earlier[i]) / (2.0 * step);
      const double residual = estimate[i] - ratio * reference[i];
      slopes += slope * slope;
      residuals += residual * residual;
    }
    if (residuals > 0.0) {
      information += slopes * static_cast<double>(reference.size()) / residuals;
    }
  };
  add(here.reference_angle, here.estimate_angle, after.reference_angle, before.reference_angle);
  add(here.reference_distance,
      here.estimate_distance,
      after.reference_distance,
      before.reference_distance);
  return information > 0.0 ? 1.0 / std::sqrt(information) : INFINITY;
}

/// Whether the correlation of the speeds is clearly higher with the offset. At constant speed, it
/// is the same at all offsets but for rounding errors, which can be explained completely.
bool raises_correlation(const TimeOffset& found) {
  constexpr double kGain = 0.005;
  constexpr double kSmallGain = 0.0005, kShare = 0.5;  // of what is unexplained without the offset
  const double gain = found.correlation - found.before;
  return gain >= kGain || (gain >= kSmallGain && gain >= kShare * (1.0 - found.before));
}

}  // namespace

std::optional<TimeOffset> estimate_time_offset(const Trajectory& reference,
                                               const Trajectory& estimate) {
  constexpr std::size_t kFewestPoses = 20;
  constexpr double kLeastCorrelation = 0.6, kLeastOfSpeeds = 0.3;
  if (reference.size() < kFewestPoses || estimate.size() < kFewestPoses) return std::nullopt;
  const SpeedMatch match(reference, estimate);
  TimeOffset out;
  const SpeedMatch::Score before = match.score(0.0);
  const double at_zero = before.best();
  out.before = std::max(0.0, at_zero);
  out.has_common_time = before.is_known;
  const double coarse = std::clamp(match.interval(), 0.1, 0.5);
  Best best = search(match, -kSearch, kSearch, coarse);
  if (best.score < 0.0) {
    constexpr double kMostSteps = 2000.0;
    // At least half of the shorter one must be common: a short overlap can fit by chance.
    const double duration = std::min(reference.back().stamp - reference.front().stamp,
                                     estimate.back().stamp - estimate.front().stamp);
    const double low = reference.front().stamp - estimate.back().stamp + 0.5 * duration;
    const double high = reference.back().stamp - estimate.front().stamp - 0.5 * duration;
    best = search(match, low, high, std::max(coarse, (high - low) / kMostSteps));
    const double step = std::max(coarse, (high - low) / kMostSteps);
    best = search(match, best.offset - step, best.offset + step, 0.2 * coarse);
  }
  if (at_zero > best.score) best = {0.0, at_zero};
  const double fine = 0.2 * coarse;
  if (before.is_known) best = nearest_of_equal(match, best, fine);
  best = search(match, best.offset - coarse, best.offset + coarse, fine);
  out.offset = vertex(match, best.offset, fine);
  const SpeedMatch::Score after = match.score(out.offset);
  out.correlation = after.best();
  if (out.correlation < kLeastCorrelation ||
      match.score_of_speeds(out.offset).best() < kLeastOfSpeeds) {
    return std::nullopt;
  }
  const auto unexplained = [](double now, double then) {
    constexpr double kUseful = 0.7;
    constexpr double kRounding = 1e-6;  // at a constant speed all offsets fit equally well
    if (1.0 - then < kRounding) return 1.0;
    return now < kUseful ? 1.0 : (1.0 - now) / std::max(1e-9, 1.0 - std::max(0.0, then));
  };
  out.unexplained = std::min(unexplained(after.angle, before.angle),
                             unexplained(after.distance, before.distance));
  out.deviation = deviation_of(match, out.offset, 0.5 * fine);
  return out;
}

std::optional<InputFinding> offset_finding(const TimeOffset& found, const Trajectory& estimate) {
  constexpr double kSmallest = 0.04;   // [s]; smaller ones are common and hardly matter
  constexpr double kOfInterval = 0.6;  // a scan has no exact time within its duration
  constexpr double kDeviations = 4.0;
  constexpr double kMostUnexplained = 0.75;  // 1 - correlation, after over before
  constexpr double kClear = 8.0;             // deviations that need less explanation
  constexpr double kMostIfClear = 0.95;
  constexpr double kLeastAlone = 0.85;  // of files without common time
  const double size = std::abs(found.offset);
  const double interval = std::min(0.2, usual_interval(estimate));
  const double remaining = found.unexplained;
  if (size < std::max(kSmallest, kOfInterval * interval)) return std::nullopt;
  if (!raises_correlation(found)) return std::nullopt;
  if (!found.has_common_time && found.correlation < kLeastAlone) return std::nullopt;
  const double most = size > kClear * found.deviation ? kMostIfClear : kMostUnexplained;
  if (size < kDeviations * found.deviation || remaining > most) return std::nullopt;
  return InputFinding{Fault::time_offset,
                      fmt::format("the estimate's stamps are {:.3f} +- {:.3f} s {} the reference's "
                                  "(correlation of speeds {:.3f}, without offset {:.3f})",
                                  size,
                                  found.deviation,
                                  found.offset > 0.0 ? "behind" : "ahead of",
                                  found.correlation,
                                  found.before),
                      fmt::format("--offset {:.4f}", found.offset),
                      std::clamp(1.0 - remaining, 0.0, 1.0),
                      found.offset};
}

}  // namespace loopbench::metrics
