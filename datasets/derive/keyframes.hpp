/// Which poses of an estimate are its keyframes, and what becomes of the others.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench {

enum class KeyframeRule { all, every, seconds, metres, count };
inline auto choices(KeyframeRule) {
  return std::array{std::pair{"all", KeyframeRule::all},
                    std::pair{"every", KeyframeRule::every},
                    std::pair{"seconds", KeyframeRule::seconds},
                    std::pair{"metres", KeyframeRule::metres},
                    std::pair{"count", KeyframeRule::count}};
}

struct KeyframeChoice {
  KeyframeRule rule = KeyframeRule::all;
  double value = 1.0;  ///< k poses | at least [s] apart | at least [m] apart | how many
};

/// Ascending indices; first and last pose are always among them, so the last one may be nearer
/// than the rule asks. `metres` measures the straight line from the keyframe before. `count` is
/// even in pose index. Throws OptionError when the value does not fit the rule or the poses. O(n).
std::vector<std::size_t> choose_keyframes(const Trajectory& poses, const KeyframeChoice& choice);

struct KeyframeSplit {
  Trajectory keyframes;
  Trajectory frames;  ///< the rest
};

/// `kept` ascending and unique.
KeyframeSplit split(const Trajectory& poses, const std::vector<std::size_t>& kept);

/// Those frames of a run that lie between its first and last keyframe and are no keyframe
/// themselves (no stamp within a millisecond: cameras are slower). O(n + m).
Trajectory frames_between(const Trajectory& keyframes, const Trajectory& frames);

}  // namespace loopbench
