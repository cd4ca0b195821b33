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
  std::size_t intervals() const { return motions_.size(); }

  struct Score {
    double angle = 0.0;
    double distance = 0.0;
    bool is_known = false;  ///< at least a fifth of the intervals are common

    /// One of the speeds is enough: a vehicle at constant speed, a drifting scale.
    double best() const;
  };

  Score score(double offset) const { return score(signals(offset)); }

  /// Of speeds instead of steps: at constant speeds, steps correlate at any offset if the durations
  /// of intervals differ.
  Score score_of_speeds(double offset) const;

  double at(double offset) const { return score(offset).best(); }

 private:
  /// Motion of the estimate between two of its stamps.
  struct TimedMotion {
    double begin = 0.0;
    double end = 0.0;
    double angle = 0.0;
    double distance = 0.0;
  };

  MotionSignals signals(double offset) const;
  Score score(const MotionSignals& signals) const;
  std::optional<Pose> reference_at(double stamp) const;

  const Trajectory& reference_;
  std::vector<TimedMotion> motions_;
  double interval_ = 0.0;
  double rate_ = 0.0;  ///< poses of the reference per second
  double longest_gap_ = 0.0;
};

}  // namespace loopbench::metrics
