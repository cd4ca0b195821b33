/// Which older keyframes a keyframe looks like.
#pragma once

#include <vector>

#include "datasets/rgbd/loops/detector.hpp"

namespace loopbench {

struct Alike {
  std::size_t keyframe = 0;
  double similarity = 0.0;  ///< over the asking keyframe's to its neighbour, 0..
};

/// For every keyframe its candidates, best first, empty where none is alike or consistent.
/// O(keyframes^2).
std::vector<std::vector<Alike>> retrieve(const std::vector<Keyframe>& keyframes,
                                         const LoopOptions& options);

}  // namespace loopbench
