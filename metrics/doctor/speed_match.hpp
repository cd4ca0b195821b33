/// Speeds of two trajectories compared at a time offset.
#pragma once

#include <optional>
#include <vector>

#include "metrics/doctor/common_motion.hpp"

namespace loopbench::metrics {

/// Intervals of the estimate that count: all, or alternate blocks for fits and for tests.
enum class Part { all, fitted, tested };

/// Correlation of speeds for offsets between two trajectories, over at most 600 intervals that do
/// not overlap.
class SpeedMatch {
 public:
  SpeedMatch(const Trajectory& reference, const Trajectory& estimate, Part part = Part::all);

  double interval() const { return interval_; }
  std::size_t intervals() const { return speeds_.size(); }

  struct Score {
    double angle = 0.0;
    double distance = 0.0;
    bool is_known = false;  ///< at least a fifth of the intervals are common

    /// One of the speeds is enough: a vehicle at constant speed, a drifting scale.
    double best() const;
  };

  /// Of speeds, not of steps: at constant speeds, steps correlate at any offset if the durations of
  /// intervals differ.
  Score score(double offset) const;

  double at(double offset) const { return score(offset).best(); }

 private:
  /// Speeds of the estimate between two of its stamps.
  struct TimedSpeed {
    double begin = 0.0;
    double end = 0.0;
    double angle = 0.0;     ///< [rad/s]
    double distance = 0.0;  ///< [m/s]
  };

  /// Searches from the index `hint` on, and sets it.
  std::optional<Pose> reference_at(double stamp, std::size_t& hint) const;

  const Trajectory& reference_;
  std::vector<TimedSpeed> speeds_;
  double interval_ = 0.0;
  double longest_gap_ = 0.0;
};

}  // namespace loopbench::metrics
