/// Motions and parts of paired rows, for the checks of maps.
#pragma once

#include <fmt/format.h>

#include <string>

#include "datasets/core/so3.hpp"
#include "metrics/doctor/map_checks.hpp"
#include "metrics/numerics/average.hpp"

namespace loopbench::metrics::map_pairs {

inline const Pose& pose_in(const Trajectory& poses, std::size_t i) {
  return poses[i].world_from_body;
}

inline double displacement(const Trajectory& poses, std::size_t i, std::size_t j) {
  return (pose_in(poses, j).translation - pose_in(poses, i).translation).norm();
}

inline double angle(const Trajectory& poses, std::size_t i, std::size_t j) {
  return angle_between(pose_in(poses, i).rotation, pose_in(poses, j).rotation);
}

inline double spread(const Trajectory& poses) {
  return spread_of(poses.size(),
                   [&](std::size_t i) -> const Vector3& { return pose_in(poses, i).translation; });
}

inline Paired cut(const Paired& all, const RowRange& range) {
  const auto of = [&](const Trajectory& list) {
    return Trajectory(list.begin() + static_cast<long>(range.begin),
                      list.begin() + static_cast<long>(range.end));
  };
  return {of(all.reference), of(all.estimate)};
}

inline bool are_equal(const Pose& a, const Pose& b) {
  return (a.translation - b.translation).norm() <= kFileRounding * (1.0 + a.translation.norm()) &&
         (a.rotation.coeffs() - b.rotation.coeffs()).norm() <= kFileRounding;
}

/// The row of the file with a stamp, or the one after it.
inline std::size_t row_at(const Trajectory& file, double stamp) { return first_from(file, stamp); }

inline std::string place(const Trajectory& file, std::size_t row) {
  return fmt::format("row {} (from 0 on, stamp {:.3f})", row, file[row].stamp);
}

}  // namespace loopbench::metrics::map_pairs
