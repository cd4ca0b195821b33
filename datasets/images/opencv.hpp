/// OpenCV finds and matches features; stb reads images. A build without it has every dataset but
/// those of images.
#pragma once

namespace loopbench::rgbd {

inline constexpr const char* kWithoutOpencv =
    "this build has no image front end: OpenCV or stb was not found when loopbench was configured "
    "(Debian 12: libopencv-features2d-dev, libopencv-calib3d-dev, libstb-dev)";

/// Whether find_features(), match_exhaustive() and pose_by_ransac() can be called; without OpenCV
/// they throw MissingPart.
bool has_opencv();

/// Frames are distributed over the cores by the front end, so OpenCV itself runs on one thread.
void run_opencv_on_one_thread();

}  // namespace loopbench::rgbd
