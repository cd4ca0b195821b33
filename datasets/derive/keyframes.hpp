/// Selection of keyframes from the poses of an estimate.
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
  double value = 1.0;  ///< interval [poses], minimum spacing [s] or [m], or number of keyframes
};

/// `count` evenly spaced indices from 0 to size - 1.
std::vector<std::size_t> even_indices(std::size_t size, std::size_t count);

/// Returns ascending indices of the keyframes. The first and the last pose are always selected, so
/// the last spacing may be smaller than required. `metres` uses the Euclidean distance to the
/// previous keyframe. `count` distributes keyframes evenly by pose index. Throws OptionError if the
/// value is invalid for the rule or the number of poses. O(n).
std::vector<std::size_t> choose_keyframes(const Trajectory& poses, const KeyframeChoice& choice);

struct KeyframeSplit {
  Trajectory keyframes;
  Trajectory frames;  ///< all other poses
};

/// Separates poses into keyframes and frames. `kept` holds ascending unique indices. O(n).
KeyframeSplit split(const Trajectory& poses, const std::vector<std::size_t>& kept);

/// Returns the frames between the first and the last keyframe that are not keyframes, i.e. differ
/// by more than 1 ms from all keyframe stamps. O(n + m).
Trajectory non_keyframes_between(const Trajectory& keyframes, const Trajectory& frames);

}  // namespace loopbench
