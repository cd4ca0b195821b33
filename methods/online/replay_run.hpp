/// One replay of a problem by an incremental method.
#pragma once

#include <span>

#include "datasets/core/replay.hpp"
#include "methods/incremental.hpp"
#include "methods/online/arrivals.hpp"
#include "methods/online/extended_chain.hpp"

namespace loopbench::methods {

/// Passes the data to `method`, and records its answers and times.
class ReplayRun {
 public:
  /// All references must outlive this object. `every`: arrivals that start an update.
  ReplayRun(const Problem& problem, Incremental& method, std::size_t every, Report& report)
      : problem_(problem), method_(method), every_(every), report_(report), chain_(problem) {}

  /// Replays the complete problem. `arrivals` are sorted by time.
  void run(std::span<const Arrival> arrivals);

  /// The record; run() comes first.
  Replay take_replay() { return std::move(replay_); }

  /// Poses of all keyframes after the last update.
  const Trajectory& poses() const { return chain_.poses(); }

 private:
  void add_keyframe(std::size_t i);
  void add(const Arrival& arrival);
  void update(double time);

  const Problem& problem_;
  Incremental& method_;
  std::size_t every_;
  Report& report_;
  ExtendedChain chain_;
  Increment waiting_;
  std::size_t edges_ = 0;   ///< odometry edges passed on
  std::size_t frames_ = 0;  ///< frames passed on
  Replay replay_;
};

}  // namespace loopbench::methods
