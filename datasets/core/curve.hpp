/// A trajectory that can be asked for its pose at any time in its span.
#pragma once

#include <span>
#include <stdexcept>
#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// Every estimate is judged as a curve: between keyframes is where smoothers differ.
class Curve {
 public:
  virtual ~Curve() = default;

  virtual double start() const = 0;  ///< first time it knows [s]
  virtual double end() const = 0;    ///< last time it knows [s]

  /// poses[i] = world_from_body at times[i]; same size. Any order of times is allowed; sorted
  /// ones cost O(n + m). Throws std::out_of_range for a time outside start()..end().
  virtual void sample(std::span<const double> times, std::span<Pose> poses) const = 0;

  Pose at(double time) const {
    Pose pose;
    sample({&time, 1}, {&pose, 1});
    return pose;
  }

  Trajectory sample(const std::vector<double>& times) const {
    std::vector<Pose> poses(times.size());
    sample(times, poses);
    Trajectory out(times.size());
    for (std::size_t i = 0; i < times.size(); ++i) out[i] = {times[i], poses[i]};
    return out;
  }
};

}  // namespace loopbench
