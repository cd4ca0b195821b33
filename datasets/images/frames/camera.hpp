/// Pinhole camera with distortion. Axes: x right, y down, z forward.
#pragma once

#include <filesystem>

#include "datasets/core/so3.hpp"

namespace loopbench::rgbd {

struct Camera {
  int width = 640;                                          ///< [px]
  int height = 480;                                         ///< [px]
  double fx = 525.0, fy = 525.0;                            ///< [px]
  double cx = 319.5, cy = 239.5;                            ///< [px]
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;  ///< Brown distortion, order of OpenCV
  double depth_scale = 5000.0;                              ///< depth image value of 1 m [1/m]

  Eigen::Vector2d project(const Vector3& point) const {
    return {fx * point.x() / point.z() + cx, fy * point.y() / point.z() + cy};
  }
  /// Point at depth z [m] on the ray of an undistorted pixel, in camera axes [m].
  Vector3 back_project(double u, double v, double z) const {
    return {(u - cx) / fx * z, (v - cy) / fy * z, z};
  }
  bool distorted() const { return k1 != 0.0 || k2 != 0.0 || p1 != 0.0 || p2 != 0.0 || k3 != 0.0; }
};

/// Reads `key: value` lines: width, height, fx, fy, cx, cy, depth_scale and
/// `distortion: [k1, k2, p1, p2, k3]`. fx, fy, cx, cy are required; unknown keys are ignored.
/// Throws InputError with file and line for a value that is not a number or not positive, a
/// principal point outside the image, and a repeated or missing key.
Camera read_camera(const std::filesystem::path& file);

/// Calibration published with TUM RGB-D (colour camera, depth registered to it) of fr1, fr2 or fr3.
/// Throws std::invalid_argument for other numbers. Source: TUM RGB-D, file formats, "Intrinsic
/// Camera Calibration of the Kinect".
Camera tum_camera(int freiburg);

}  // namespace loopbench::rgbd
