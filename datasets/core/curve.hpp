/// Interface of a continuous-time trajectory.
#pragma once

#include <span>
#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench {

struct Replay;

/// All estimates are evaluated as curves, because smoothers differ between keyframes.
class Curve {
 public:
  virtual ~Curve() = default;

  virtual double start() const = 0;  ///< first valid time [s]
  virtual double end() const = 0;    ///< last valid time [s]

  /// Writes world_from_body at times[i] [s] to poses[i]; both spans have the same size. Times may
  /// be in any order. Throws std::out_of_range for a time outside start()..end(). O(n + m) for
  /// sorted times.
  virtual void sample(std::span<const double> times, std::span<Pose> poses) const = 0;

  /// The record of the replay that ended with this curve (replay.hpp); null for other curves.
  virtual const Replay* replay() const { return nullptr; }

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
