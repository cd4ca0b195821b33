#include "metrics/alignment/hand_eye/rotating_intervals.hpp"

#include <cmath>

namespace loopbench::metrics {

std::vector<RelativePosePair> rotating_intervals(const Trajectory& reference,
                                                 const Trajectory& estimate,
                                                 double angle,
                                                 double longest) {
  const double cosine = std::cos(0.5 * angle);
  const auto has_rotated = [&](const Trajectory& poses, std::size_t from, std::size_t to) {
    const Rotation& a = poses[from].world_from_body.rotation;
    return std::abs(a.dot(poses[to].world_from_body.rotation)) <= cosine;
  };
  const auto motion = [](const Trajectory& poses, std::size_t from, std::size_t to) {
    return poses[from].world_from_body.inverse() * poses[to].world_from_body;
  };
  std::vector<RelativePosePair> out;
  std::size_t begin = 0;
  for (std::size_t i = 1; i < estimate.size(); ++i) {
    const bool is_late = estimate[i].stamp - estimate[begin].stamp > longest;
    const bool rotated = has_rotated(estimate, begin, i) && has_rotated(reference, begin, i);
    if (rotated && !is_late)
      out.push_back({motion(reference, begin, i), motion(estimate, begin, i)});
    if (rotated || is_late) begin = i;
  }
  return out;
}

}  // namespace loopbench::metrics
