/// Properties of a trajectory: what `traj info` prints.
#pragma once

#include <string>
#include <vector>

#include "datasets/formats/trajectory_file.hpp"

namespace loopbench::harness {

struct TrajectorySummary {
  std::string name;
  std::string format;
  std::size_t poses = 0;
  double start = 0.0;                   ///< first stamp [s]
  double end = 0.0;                     ///< last stamp [s]
  double duration = 0.0;                ///< [s]
  double length = 0.0;                  ///< path length [m]
  double rate = 0.0;                    ///< 1 / median interval [Hz]; 0 below two poses
  double mean_speed = 0.0;              ///< length / duration [m/s]
  double largest_speed = 0.0;           ///< [m/s]
  double largest_rotation_speed = 0.0;  ///< [deg/s]
  double longest_interval = 0.0;        ///< [s]
  std::size_t gaps = 0;                 ///< intervals above ten times the median and 0.5 s
  double rotation = 0.0;                ///< accumulated rotation angle [deg]
  Vector3 low = Vector3::Zero();        ///< corners of the bounding box [m]
  Vector3 high = Vector3::Zero();
  bool has_covariances = false;
  std::vector<std::string> remarks;  ///< what looks wrong
};

/// O(n log n).
TrajectorySummary summarise(const std::string& name,
                            const TrajectoryFile& file,
                            const ReadFindings& findings);

std::string text(const TrajectorySummary& summary);

/// Array of objects with the fields above.
std::string json(const std::vector<TrajectorySummary>& summaries);

}  // namespace loopbench::harness
