/// Camera pose from 3D-2D correspondences: RANSAC and nonlinear refinement.
#pragma once

#include <optional>
#include <vector>

#include "datasets/core/se3.hpp"
#include "datasets/images/features/matching.hpp"
#include "datasets/images/frames/camera.hpp"

namespace loopbench::rgbd {

struct Observation {
  Vector3 in_world;            ///< point in the world frame [m]
  double u = 0.0;              ///< [px]
  double v = 0.0;              ///< [px]
  double inverse_depth = 0.0;  ///< [1/m]; 0: not measured
  double sigma = 1.0;          ///< standard deviation of u and v relative to kPixelSigma [-]
};

inline constexpr double kPixelSigma = 1.0;           ///< standard deviation of a feature [px]
inline constexpr double kInverseDepthSigma = 0.003;  ///< standard deviation [1/m]
/// Factor on the information of a pose, below 1 because residuals are correlated [-].
inline constexpr double kInformationScale = 0.1;

/// Estimates world_from_camera by P3P (Ke and Roumeliotis 2017) with RANSAC, using
/// cv::solvePnPRansac with a fixed random seed, so that results are bit-identical. Returns nothing
/// if no pose is found or if there are fewer than four observations.
std::optional<Pose> pose_by_ransac(const std::vector<Observation>& observations,
                                   const Camera& camera);

struct RefinedPose {
  Pose world_from_camera;
  std::vector<bool> inlier = {};  ///< one per observation
  std::size_t inliers = 0;
  Matrix6 information = Matrix6::Zero();  ///< of the twist e in world_from_camera * exp(e)
  double residual_rms = 0.0;  ///< RMS of whitened inlier residuals; 1 if the noise model is correct
};

/// Refines a pose by Gauss-Newton on pixel and inverse-depth residuals with Huber weights. After
/// each of four rounds, observations above the 95 % quantile of chi^2 become outliers; they may
/// become inliers again. The information is that of the inliers, multiplied by kInformationScale
/// and divided by residual_rms^2 if that is above 1. It is zero if fewer than six inliers remain.
/// O(observations).
RefinedPose refine_pose(const std::vector<Observation>& observations,
                        const Camera& camera,
                        const Pose& begin);

/// Converts matches to observations of map points in an image, in the same order. O(matches).
std::vector<Observation> observations(const std::vector<MapPoint>& points,
                                      const Features& features,
                                      const std::vector<Match>& matches);

}  // namespace loopbench::rgbd
