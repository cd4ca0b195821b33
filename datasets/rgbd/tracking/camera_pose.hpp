/// Where the camera stands, from points in space and where it sees them.
#pragma once

#include <optional>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/core/se3.hpp"
#include "datasets/rgbd/camera.hpp"

namespace loopbench {

struct Observation {
  Vector3 in_world;            ///< [m]
  double u = 0.0;              ///< [px]
  double v = 0.0;              ///< [px]
  double inverse_depth = 0.0;  ///< [1/m]; 0: not measured
  double sigma = 1.0;          ///< of u and v over `pixel_sigma` [-]
};

struct PoseOptions {
  double pixel_sigma = 1.0;
  double inverse_depth_sigma = 0.003;
  std::int64_t ransac_iterations = 200;
  double ransac_pixels = 4.0;
  double information_scale = 0.1;
};

template <class Visit>
void fields(PoseOptions& o, Visit visit) {
  visit("pose.pixel_sigma", o.pixel_sigma, "of a feature's place [px]", Above{0});
  visit("pose.inverse_depth_sigma", o.inverse_depth_sigma, "of 1 / depth [1/m]", Above{0});
  visit("pose.ransac_iterations", o.ransac_iterations, "at most", Between{1, 100000});
  visit("pose.ransac_pixels", o.ransac_pixels, "farthest that an inlier lies off [px]", Above{0});
  visit("pose.information_scale",
        o.information_scale,
        "share of the residuals' information that is believed: they are not independent [-]",
        Above{0});
}

/// Perspective from three points within RANSAC (Ke and Roumeliotis 2017), by cv::solvePnPRansac
/// with its random numbers begun anew at every call: same input, same bits. Nothing when no pose is
/// found; fewer than four observations find none.
std::optional<Pose> pose_by_ransac(const std::vector<Observation>& observations,
                                   const Camera& camera,
                                   const PoseOptions& options);

struct RefinedPose {
  Pose world_from_camera;
  std::vector<bool> inlier = {};  ///< one an observation
  std::size_t inliers = 0;
  Matrix6 information = Matrix6::Zero();  ///< of the twist e in world_from_camera * exp(e)
  double spread = 0.0;                    ///< rms of whitened inlier residuals; 1 as modelled
};

/// Gauss-Newton over pixel and inverse-depth residuals with Huber's weights; after each of four
/// rounds what breaks the 95 % bound of chi^2 is set aside and may come back. The information is
/// that of the inliers, divided by their spread^2 when that is above 1, times information_scale.
/// Zero information when fewer than six inliers remain. O(observations).
RefinedPose refine_pose(const std::vector<Observation>& observations,
                        const Camera& camera,
                        const Pose& begin,
                        const PoseOptions& options);

}  // namespace loopbench
