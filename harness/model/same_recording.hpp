/// Recordings behind references.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "metrics/alignment/alignment.hpp"

namespace loopbench::harness {

/// Names recordings by the first of their references.
class Recordings {
 public:
  /// `content`: hash of the poses.
  std::string name_of(const std::string& content, const Trajectory& reference);

 private:
  std::vector<std::pair<std::string, Trajectory>> known_;
};

/// Position at a time within the trajectory, linear between poses.
inline StampedPose position_at(const Trajectory& poses, double time) {
  const auto next = std::ranges::lower_bound(poses, time, {}, &StampedPose::stamp);
  if (next == poses.begin()) return poses.front();
  if (next == poses.end()) return poses.back();
  const StampedPose& before = *(next - 1);
  const double share = (time - before.stamp) / (next->stamp - before.stamp);
  StampedPose out{time, {}};
  out.world_from_body.translation = before.world_from_body.translation * (1.0 - share) +
                                    next->world_from_body.translation * share;
  return out;
}

/// Whether two references are one recording: after a rigid alignment, their positions at common
/// stamps (half of the shorter one's duration at least) differ by less than 1 % of their spread,
/// RMSE. Finds copies that are cropped, resampled, scaled by 0.1 % or have noise of some
/// millimetres, but none with other stamps. O(n).
inline bool is_same_recording(const Trajectory& one, const Trajectory& other) {
  constexpr std::size_t kSamples = 200;
  constexpr double kShare = 0.01;
  const double begin = std::max(one.front().stamp, other.front().stamp);
  const double end = std::min(one.back().stamp, other.back().stamp);
  const double shorter =
      std::min(one.back().stamp - one.front().stamp, other.back().stamp - other.front().stamp);
  if (!(shorter > 0.0) || end - begin < 0.5 * shorter) return false;
  Trajectory ones;
  Trajectory others;
  Vector3 center = Vector3::Zero();
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double time = begin + (end - begin) * static_cast<double>(i) / (kSamples - 1);
    ones.push_back(position_at(one, time));
    others.push_back(position_at(other, time));
    center += ones.back().world_from_body.translation / static_cast<double>(kSamples);
  }
  try {
    others = metrics::moved(metrics::align(ones, others, metrics::Align::se3), others);
  } catch (const std::runtime_error&) {
    return false;  // at rest or on a straight line, which are no evidence
  }
  double differences = 0.0;
  double spread = 0.0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const Vector3& position = ones[i].world_from_body.translation;
    differences += (position - others[i].world_from_body.translation).squaredNorm();
    spread += (position - center).squaredNorm();
  }
  return differences < kShare * kShare * spread;
}

inline std::string Recordings::name_of(const std::string& content, const Trajectory& reference) {
  for (const auto& [name, poses] : known_) {
    if (name == content || is_same_recording(poses, reference)) return name;
  }
  known_.emplace_back(content, reference);
  return content;
}

}  // namespace loopbench::harness
