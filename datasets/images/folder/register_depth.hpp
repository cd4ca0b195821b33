/// Registration of depth images to another camera.
#pragma once

#include <cmath>

#include "datasets/core/pose.hpp"
#include "datasets/images/frames/camera.hpp"
#include "datasets/images/frames/image.hpp"

namespace loopbench::rgbd {

struct CameraPair {
  Camera colour;
  Camera depth;
  Pose colour_from_depth;
};

inline Camera kinect(double focal) {
  Camera out;
  out.fx = out.fy = focal;
  out.cx = 320.0;
  out.cy = 240.0;
  out.depth_scale = 1000.0;
  return out;
}

/// Calibration of a Kinect without depth registration by its driver: depth focal length 585 px,
/// colour focal length `colour_focal` [px], principal points in the image centre, baseline 25.6 mm.
/// Source: calibration of a Kinect by LIRIS (projet.liris.cnrs.fr/voir, "Kinect calibration"), as
/// used with 7-Scenes by ACE and DSAC*.
inline CameraPair unregistered_kinect(double colour_focal = 525.0) {
  Matrix3 R;
  R << 9.9996518012567637e-01, 2.6765126468950343e-03, -7.9041012313000904e-03,
      -2.7409311281316700e-03, 9.9996302803027592e-01, -8.1504520778013286e-03,
      7.8819942130445332e-03, 8.1718328771890631e-03, 9.9993554558014031e-01;
  const Vector3 t(-2.5558943178152542e-02, 1.0109636268061706e-04, 2.0318321729487039e-03);
  return {kinect(colour_focal), kinect(585.0), {Rotation(Eigen::Quaterniond(R).normalized()), t}};
}

/// Projects all depth pixels into the colour camera and keeps the nearest point per pixel. Pixels
/// without a projected point have no depth. O(pixels).
inline DepthImage register_depth(const DepthImage& depth, const CameraPair& cameras) {
  const Matrix3 R = cameras.colour_from_depth.rotation.toRotationMatrix();
  DepthImage out(cameras.colour.width, cameras.colour.height);
  for (int y = 0; y < depth.height; ++y) {
    for (int x = 0; x < depth.width; ++x) {
      const auto z = static_cast<double>(depth.at(x, y));
      if (!(z > 0.0)) continue;
      const Vector3 point =
          R * cameras.depth.back_project(x, y, z) + cameras.colour_from_depth.translation;
      if (!(point.z() > 0.0)) continue;
      const Eigen::Vector2d pixel = cameras.colour.project(point);
      const int u = static_cast<int>(std::lround(pixel.x()));
      const int v = static_cast<int>(std::lround(pixel.y()));
      if (u < 0 || v < 0 || u >= out.width || v >= out.height) continue;
      float& nearest = out.at(u, v);
      const auto measured = static_cast<float>(point.z());
      if (nearest == 0.0f || measured < nearest) nearest = measured;
    }
  }
  return out;
}

}  // namespace loopbench::rgbd
