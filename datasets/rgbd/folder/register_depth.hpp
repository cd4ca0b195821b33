/// Registration of depth images to another camera.
#pragma once

#include "datasets/core/pose.hpp"
#include "datasets/rgbd/images/camera.hpp"
#include "datasets/rgbd/images/image.hpp"

namespace loopbench::rgbd {

struct CameraPair {
  Camera colour;
  Camera depth;
  Pose colour_from_depth;
};

/// Calibration of a Kinect without depth registration by its driver: depth focal length 585 px,
/// colour focal length `colour_focal` [px], principal points in the image centre, baseline 25.6 mm.
/// Source: calibration of a Kinect by LIRIS (projet.liris.cnrs.fr/voir, "Kinect calibration"), as
/// used with 7-Scenes by ACE and DSAC*.
CameraPair unregistered_kinect(double colour_focal = 525.0);

/// Projects all depth pixels into the colour camera and keeps the nearest point per pixel. Pixels
/// without a projected point have no depth. O(pixels).
DepthImage register_depth(const DepthImage& depth, const CameraPair& cameras);

}  // namespace loopbench::rgbd
