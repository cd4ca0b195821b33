/// Retrieval of similar older keyframes.
#pragma once

#include <vector>

#include "datasets/rgbd/loops/detector.hpp"

namespace loopbench::rgbd {

struct RetrievedKeyframe {
  std::size_t keyframe = 0;
  double similarity =
      0.0;  ///< relative to the similarity of the query and its predecessor, >= 0 [-]
};

/// Returns the consistent candidates of each keyframe, most similar first. O(keyframes^2).
std::vector<std::vector<RetrievedKeyframe>> retrieve(const std::vector<Keyframe>& keyframes,
                                                     const LoopOptions& options);

}  // namespace loopbench::rgbd
