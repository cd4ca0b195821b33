/// Consistency check of the assumed focal length with images and depth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/rgbd/tracking/tracker.hpp"

namespace loopbench::rgbd {

struct FocalCheck {
  double factor = 1.0;    ///< estimated factor on both focal lengths [-]
  double sigma = 0.0;     ///< standard deviation of factor; infinite if it is not observable [-]
  std::size_t pairs = 0;  ///< number of pairs of consecutive keyframes used
};

/// Estimates a common factor on both focal lengths from the reprojection of features with depth
/// between consecutive keyframes, which is inconsistent for a wrong focal length. Gauss-Newton over
/// the factor and one (eliminated) pose per pair. The reference is not used. If depth images were
/// registered with wrong intrinsics, the estimated factor is biased. O(keyframes * features).
FocalCheck check_focal(const std::vector<Keyframe>& keyframes, const Camera& camera);

/// Returns a warning if the factor differs from 1 by more than 5 % and five standard deviations.
std::optional<std::string> focal_warning(const FocalCheck& check, const Camera& camera);

}  // namespace loopbench::rgbd
