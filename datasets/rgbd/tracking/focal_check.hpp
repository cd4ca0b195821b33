/// Do the images agree with the focal length that the camera is said to have?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/rgbd/tracking/tracker.hpp"

namespace loopbench {

struct FocalCheck {
  double factor = 1.0;    ///< both focal lengths times this fit best [-]
  double sigma = 0.0;     ///< of factor, as residuals say; infinite when nothing tells [-]
  std::size_t pairs = 0;  ///< neighbouring keyframes that were compared
};

/// Between neighbouring keyframes, measured depth turns pixels into points, and points into pixels
/// and depth again; a wrong focal length bends that. Gauss-Newton over one factor common to all
/// pairs and a pose for each, eliminated. No reference is looked at. The depth of a pixel is taken
/// as it is: where depth was registered with wrong intrinsics it cannot tell by how much.
/// O(keyframes * features).
FocalCheck check_focal(const std::vector<Keyframe>& keyframes,
                       const Camera& camera,
                       const TrackOptions& options);

/// What a user should know: the factor is off by more than a twentieth and surely so. Else nothing.
std::optional<std::string> focal_warning(const FocalCheck& check, const Camera& camera);

}  // namespace loopbench
