#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "datasets/core/interpolate.hpp"
#include "metrics/doctor/pair_checks.hpp"

namespace loopbench::metrics {
namespace {

constexpr double kUsuallySearched = 10.0;  // [s]

/// Pearson's correlation; 0 for a constant.
double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto centred = [](const std::vector<double>& values) {
    const auto size = static_cast<Eigen::Index>(values.size());
    const Eigen::Map<const Eigen::VectorXd> all(values.data(), size);
    return Eigen::VectorXd(all.array() - all.mean());
  };
  const Eigen::VectorXd x = centred(a), y = centred(b);
  const double norm = x.norm() * y.norm();
  return norm > 0.0 ? x.dot(y) / norm : 0.0;
}

/// Correlation of speeds for offsets between two trajectories, over at most 600 intervals that do
/// not overlap.
class SpeedMatch {
 public:
  SpeedMatch(const Trajectory& reference, const Trajectory& estimate) : reference_(reference) {
    constexpr std::size_t kMostPairs = 600;
    constexpr double kShortest = 0.1, kLongest = 10.0;  // [s]; of intervals
    interval_ = std::max({kShortest, median_interval(reference), 0.99 * median_interval(estimate)});
    longest_gap_ = longest_gap(reference);
    const std::size_t step = std::max<std::size_t>(1, estimate.size() / kMostPairs);
    std::size_t j = 0;
    for (std::size_t i = 0; i < estimate.size(); i = std::max(j, i + step)) {
      j = std::max(j, i);
      while (j < estimate.size() && estimate[j].stamp - estimate[i].stamp < interval_) ++j;
      if (j == estimate.size()) break;
      const auto& [begin, from] = estimate[i];
      const auto& [end, to] = estimate[j];
      if (end - begin > kLongest * interval_) continue;
      motions_.push_back({begin,
                          end,
                          angle_between(from.rotation, to.rotation) / (end - begin),
                          (to.translation - from.translation).norm() / (end - begin)});
    }
  }

  double interval() const { return interval_; }
  auto intervals() const { return static_cast<double>(motions_.size()); }

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

  Score score(double offset) const {
    constexpr std::size_t kFewest = 10;
    std::vector<double> reference_angle, estimate_angle, reference_distance, estimate_distance;
    for (const Motion& motion : motions_) {
      const std::optional<Pose> from = reference_at(motion.begin + offset);
      const std::optional<Pose> to = reference_at(motion.end + offset);
      if (!from || !to) continue;
      const double duration = motion.end - motion.begin;
      reference_angle.push_back(angle_between(from->rotation, to->rotation) / duration);
      estimate_angle.push_back(motion.angle);
      reference_distance.push_back((to->translation - from->translation).norm() / duration);
      estimate_distance.push_back(motion.distance);
    }
    if (reference_angle.size() < std::max(kFewest, motions_.size() / 5)) return {};
    return {correlation(reference_angle, estimate_angle),
            correlation(reference_distance, estimate_distance),
            true};
  }

  double at(double offset) const { return score(offset).best(); }

 private:
  /// Motion of the estimate between two of its stamps.
  struct Motion {
    double begin = 0.0;
    double end = 0.0;
    double angle = 0.0;     // [rad/s]
    double distance = 0.0;  // [m/s]
  };

  std::optional<Pose> reference_at(double stamp) const {
    const auto found = std::ranges::lower_bound(reference_, stamp, {}, &StampedPose::stamp);
    auto after = static_cast<std::size_t>(found - reference_.begin());
    return pose_at(reference_, stamp, longest_gap_, after);
  }

  const Trajectory& reference_;
  std::vector<Motion> motions_;
  double interval_ = 0.0;
  double longest_gap_ = 0.0;
};

struct Best {
  double offset = 0.0;
  double score = -1.0;
};

/// Steps are longer if the range is: files may cover any time, and a stray stamp covers decades.
/// Periodic speeds fit equally well at several offsets; of these, the one near zero is the likely
/// one.
Best search(const SpeedMatch& match, double low, double high, double step) {
  constexpr double kMostSteps = 20'000.0, kNear = 1.0;  // [s]
  step = std::max(step, (high - low) / kMostSteps);
  const auto steps = static_cast<int>(std::floor((high - low) / step + 1e-6));
  Best best;
  for (int i = 0; i <= steps; ++i) {
    const double offset = low + i * step;
    const double score = match.at(offset);
    const double less = std::abs(offset) > kNear ? std::max(0.003, 0.1 * (1.0 - score)) : 0.0;
    if (score - less > best.score) best = {offset, score - less};
  }
  return best;
}

/// The vertex of the parabola through three scores, and its standard deviation in least squares of
/// the angles and of the distances: from the part of both that is not explained, and the curvature
/// of their correlations.
void refine(const SpeedMatch& match, double step, TimeOffset& out) {
  const SpeedMatch::Score left = match.score(out.offset - step), middle = match.score(out.offset),
                          right = match.score(out.offset + step);
  double information = 0.0;
  for (double SpeedMatch::Score::*part :
       {&SpeedMatch::Score::angle, &SpeedMatch::Score::distance}) {
    const double curvature = (2.0 * middle.*part - left.*part - right.*part) / (step * step);
    const double residual = 1.0 - middle.*part * middle.*part;
    if (residual > 0.0 && curvature > 0.0) information += curvature / residual;
  }
  out.deviation = information > 0.0 ? 1.0 / std::sqrt(information * match.intervals()) : INFINITY;
  const double curvature = left.best() - 2.0 * middle.best() + right.best();
  if (!(curvature < 0.0)) return;
  out.offset += std::clamp(0.5 * step * (left.best() - right.best()) / curvature, -step, step);
}

}  // namespace

double speed_correlation(const Trajectory& reference, const Trajectory& estimate) {
  return std::max(0.0, SpeedMatch(reference, estimate).at(0.0));
}

std::optional<TimeOffset> estimate_time_offset(const Trajectory& reference,
                                               const Trajectory& estimate,
                                               std::optional<double> searched) {
  constexpr double kLeastCorrelation = 0.6;
  if (std::min(reference.size(), estimate.size()) < kFewestCommonPoses) return std::nullopt;
  const SpeedMatch match(reference, estimate);
  TimeOffset out;
  const SpeedMatch::Score before = match.score(0.0);
  out.before = std::max(0.0, before.best());
  out.has_common_time = before.is_known;
  const double coarse = std::clamp(match.interval(), 0.1, 0.5), fine = 0.2 * coarse;
  const double nearest = searched.value_or(kUsuallySearched);
  Best best = search(match, -nearest, nearest, coarse);
  if (best.score < (searched && before.is_known ? -1.0 : kLeastCorrelation)) {
    // At least half of the shorter one must be common: a short overlap can fit by chance.
    const double duration = std::min(reference.back().stamp - reference.front().stamp,
                                     estimate.back().stamp - estimate.front().stamp);
    const double low = reference.front().stamp - estimate.back().stamp + 0.5 * duration;
    const double high = reference.back().stamp - estimate.front().stamp - 0.5 * duration;
    best = search(match, low, high, coarse);
  }
  if (before.best() > best.score) best = {0.0, before.best()};
  best = search(match, best.offset - coarse, best.offset + coarse, fine);
  out.offset = best.offset;
  refine(match, fine, out);
  // Where stamps are equal, interpolation smooths neighbouring offsets.
  if (std::isinf(out.deviation)) refine(match, coarse, out);
  out.correlation = match.at(out.offset);
  if (out.correlation < kLeastCorrelation) return std::nullopt;
  return out;
}

std::optional<InputFinding> offset_finding(const TimeOffset& found,
                                           const Trajectory& reference,
                                           const Trajectory& estimate) {
  constexpr double kSmallest = 0.02, kOfInterval = 0.35, kDeviations = 5.0;  // [s]
  constexpr double kLeastGain = 0.1, kMostRatio = 0.9, kLeastConfident = 0.3;
  constexpr double kLeastAlone = 0.85;  // correlation at large offsets
  const double size = std::abs(found.offset);
  const double interval = std::min(0.2, median_interval(estimate));
  if (size < std::max({kSmallest, kOfInterval * interval, kDeviations * found.deviation})) {
    return std::nullopt;
  }
  double confidence = 0.5;
  std::string change =
      fmt::format("correlation of speeds {:.3f} -> {:.3f}", found.before, found.correlation);
  if (found.has_common_time) {
    const Agreement before = agreement(common_poses(reference, estimate));
    const Agreement after = agreement(common_poses(reference, estimate, found.offset));
    const Improvement gained = improvement(before, after);
    if (after.cost() > before.cost() - kLeastGain || gained.ratio > kMostRatio) return std::nullopt;
    change += ", " + gained.text;
    confidence = std::max(kLeastConfident, 1.0 - gained.ratio);
  }
  const bool is_near = found.has_common_time && size <= kUsuallySearched;
  if (!is_near && found.correlation < kLeastAlone) return std::nullopt;
  return InputFinding{Fault::time_offset,
                      fmt::format("the estimate's stamps are {:.3f} +- {:.3f} s {} the "
                                  "reference's: {}",
                                  size,
                                  found.deviation,
                                  found.offset > 0.0 ? "behind" : "ahead of",
                                  change),
                      fmt::format("--offset {:.4f}", found.offset),
                      confidence,
                      found.offset};
}

}  // namespace loopbench::metrics
