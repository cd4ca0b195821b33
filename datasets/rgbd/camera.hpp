/// A pinhole camera: x to the right, y down, z ahead.
#pragma once

#include <filesystem>

#include "datasets/core/so3.hpp"

namespace loopbench {

struct Camera {
  int width = 640;                                          ///< [px]
  int height = 480;                                         ///< [px]
  double fx = 525.0, fy = 525.0;                            ///< [px]
  double cx = 319.5, cy = 239.5;                            ///< [px]
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;  ///< Brown's distortion, OpenCV's order
  double depth_scale = 5000.0;                              ///< depth image value of one metre

  Eigen::Vector2d project(const Vector3& point) const {
    return {fx * point.x() / point.z() + cx, fy * point.y() / point.z() + cy};
  }
  /// The point of depth z [m] seen at an undistorted pixel.
  Vector3 back_project(double u, double v, double z) const {
    return {(u - cx) / fx * z, (v - cy) / fy * z, z};
  }
  bool distorted() const { return k1 != 0.0 || k2 != 0.0 || p1 != 0.0 || p2 != 0.0 || k3 != 0.0; }
};

/// Reads `key: value` lines: width, height, fx, fy, cx, cy, depth_scale and
/// `distortion: [k1, k2, p1, p2, k3]`. fx, fy, cx, cy are required; a key not known is passed over.
/// Throws InputError with file and line: not a number, not positive, a principal point outside the
/// image, a key given twice or missing.
Camera read_camera(const std::filesystem::path& file);

/// Calibrations published with TUM RGB-D (colour camera, depth registered to it): 1, 2 or 3 for
/// fr1, fr2, fr3. Source: TUM RGB-D, file formats, "Intrinsic Camera Calibration of the Kinect".
Camera tum_camera(int freiburg);

}  // namespace loopbench
