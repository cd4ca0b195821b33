/// Depth of one camera as another, beside it, would have measured it.
#pragma once

#include "datasets/core/pose.hpp"
#include "datasets/rgbd/camera.hpp"
#include "datasets/rgbd/image.hpp"

namespace loopbench {

struct CameraPair {
  Camera colour;
  Camera depth;
  Pose colour_from_depth;
};

/// A Kinect whose driver did not register depth to colour: focal lengths 525 (unless told
/// otherwise) and 585 px about the middle, 25.6 mm apart. Source: calibration of a Kinect by LIRIS
/// (projet.liris.cnrs.fr/voir, "Kinect calibration"), which work on 7-Scenes uses (ACE, DSAC*).
CameraPair unregistered_kinect(double colour_focal = 525.0);

/// Every measured point goes to the colour pixel that sees it; the nearest wins. Where none lands
/// there is no depth. O(pixels).
DepthImage register_depth(const DepthImage& depth, const CameraPair& cameras);

}  // namespace loopbench
