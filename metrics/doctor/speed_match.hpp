/// Similarity of linear and angular speeds of two trajectories at any offset of their clocks.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "datasets/core/se3.hpp"
#include "metrics/doctor/sampling.hpp"
#include "metrics/numerics/average.hpp"

namespace loopbench::metrics {

inline constexpr double kSameCorrelation = 0.85;    ///< of offsets that nothing else supports
inline constexpr std::size_t kManyIntervals = 600;  ///< correlations are known to 0.04
inline constexpr std::size_t kFewIntervals = 60;    ///< for many offsets: to 0.13

/// Pearson's correlation of values that are at most three times what a tenth exceeds: a jump would
/// be all that correlates. 0 for a constant.
inline double correlation(std::vector<double> a, std::vector<double> b) {
  constexpr double kShare = 0.9, kOver = 3.0;
  const auto centred = [](std::vector<double>& values) {
    std::vector<double> sorted = values;
    std::ranges::sort(sorted);
    const double most = kOver * percentile(sorted, kShare);
    const auto size = static_cast<Eigen::Index>(values.size());
    const Eigen::Map<const Eigen::ArrayXd> all(values.data(), size);
    const Eigen::ArrayXd limited = all.min(most);
    return Eigen::VectorXd(limited - limited.mean());
  };
  const Eigen::VectorXd x = centred(a), y = centred(b);
  const double norm = x.norm() * y.norm();
  return norm > 0.0 ? x.dot(y) / norm : 0.0;
}

struct SpeedScore {
  double angle = 0.0, distance = 0.0;
  bool is_known = false;  ///< at least a fifth of the intervals are common

  /// One of the speeds is enough: a vehicle at constant speed, a drifting scale.
  double best() const {
    constexpr double kPenalty = 0.15;  // a single speed fits by chance more often
    if (!is_known) return -1.0;
    return std::max({0.5 * (angle + distance), angle - kPenalty, distance - kPenalty});
  }
};

/// Linear and angular speeds of both over intervals of the estimate that do not overlap, at most
/// `most` and evenly chosen, of at least `shortest` [s]. Its stamps are read as
/// begin + factor * (stamp - first).
class SpeedMatch {
 public:
  SpeedMatch(const Trajectory& reference,
             std::span<const StampedPose> estimate,
             std::size_t most,
             double shortest,
             double begin,
             double factor = 1.0)
      : reference_(reference), gap_(std::max(shortest, longest_gap(reference))) {
    const std::size_t step = std::max<std::size_t>(1, estimate.size() / most);
    const double first = estimate.front().stamp;
    for (std::size_t i = 0, j = 0; i < estimate.size(); i = std::max(j, i + step)) {
      const auto end =
          std::ranges::lower_bound(estimate.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                   estimate.end(),
                                   estimate[i].stamp + shortest / factor,
                                   {},
                                   &StampedPose::stamp);
      if (end == estimate.end()) break;
      j = static_cast<std::size_t>(end - estimate.begin());
      const double from = begin + factor * (estimate[i].stamp - first);
      const double to = begin + factor * (end->stamp - first);
      if (to - from > kUsualGaps * shortest) continue;
      intervals_.push_back({from, to, estimate[i].world_from_body, end->world_from_body});
    }
  }

  auto size() const { return static_cast<double>(intervals_.size()); }

  /// O(intervals log n).
  SpeedScore score(double offset) const {
    std::vector<double> angles[2], distances[2];
    const auto add = [&](int of, const Pose& from, const Pose& to, double seconds) {
      const double angle = has_rotation(from) ? angle_between(from.rotation, to.rotation) : 0.0;
      angles[of].push_back(angle / seconds);
      distances[of].push_back((to.translation - from.translation).norm() / seconds);
    };
    for (const auto& [begin, end, from, to] : intervals_) {
      const auto reference_from = pose_near(reference_, begin + offset, gap_);
      if (!reference_from) continue;
      const auto reference_to = pose_near(reference_, end + offset, gap_);
      if (!reference_to) continue;
      add(0, *reference_from, *reference_to, end - begin);
      add(1, from, to, end - begin);
    }
    if (angles[0].size() < std::max(kFewestCommonPoses / 2, intervals_.size() / 5)) return {};
    return {correlation(angles[0], angles[1]), correlation(distances[0], distances[1]), true};
  }

  double at(double offset) const { return score(offset).best(); }

 private:
  struct Interval {
    double begin, end;  // [s]
    Pose from, to;
  };
  const Trajectory& reference_;
  double gap_;
  std::vector<Interval> intervals_;
};

struct BestOffset {
  double offset = 0.0;
  double score = -1.0;
};

/// Periodic speeds fit equally well at several offsets; of these, the one near zero is likely.
inline BestOffset search_offsets(const SpeedMatch& match, double low, double high, double step) {
  constexpr double kLikely = 1.0;  // [s]
  const auto steps = static_cast<int>(std::floor((high - low) / step + 1e-6));
  BestOffset best;
  for (int i = 0; i <= steps; ++i) {
    const double offset = low + i * step;
    const double score = match.at(offset);
    const double less = std::abs(offset) > kLikely ? std::max(0.003, 0.1 * (1.0 - score)) : 0.0;
    if (score - less > best.score) best = {offset, score - less};
  }
  return best;
}

/// Shortest interval over which speeds exceed noise [s].
inline double least_interval(const Trajectory& reference, std::span<const StampedPose> estimate) {
  constexpr double kShortest = 0.1;
  return std::max({kShortest, usual_interval(reference), 0.99 * usual_interval(estimate)});
}

}  // namespace loopbench::metrics
