/// Frame source for recordings in TUM RGB-D or 7-Scenes layout.
#pragma once

#include <cstdint>
#include <memory>

#include "datasets/core/fields.hpp"
#include "datasets/images/frames/rgbd_source.hpp"

namespace loopbench::rgbd {

/// Source of the intrinsics. `automatic`: camera.yaml in the folder if it exists, else the
/// published ones if the folder name contains freiburg1 | fr1 and so on.
enum class CameraChoice { automatic, file, fr1, fr2, fr3 };
inline auto choices(CameraChoice) {
  return std::array{std::pair{"auto", CameraChoice::automatic},
                    std::pair{"file", CameraChoice::file},
                    std::pair{"fr1", CameraChoice::fr1},
                    std::pair{"fr2", CameraChoice::fr2},
                    std::pair{"fr3", CameraChoice::fr3}};
}

/// Registration of depth images to the colour camera. `registered`: depth images are already
/// registered. `kinect`: depth is registered with unregistered_kinect(), whose intrinsics replace
/// those of the folder, and the reference is converted from the depth camera to the colour camera.
/// `automatic`: kinect for 7-Scenes, else registered.
enum class DepthGeometry { automatic, registered, kinect };
inline auto choices(DepthGeometry) {
  return std::array{std::pair{"auto", DepthGeometry::automatic},
                    std::pair{"registered", DepthGeometry::registered},
                    std::pair{"kinect", DepthGeometry::kinect}};
}

struct FolderOptions {
  DepthGeometry depth = DepthGeometry::automatic;
  CameraChoice camera = CameraChoice::automatic;
  double colour_focal = 525.0;  ///< [px]
  double pair_gap = 0.02;       ///< [s]
  double rate = 30.0;           ///< [Hz]
  std::int64_t every = 1;
  std::int64_t first = 0;
  std::int64_t frames = 0;
};

template <class Visit>
void fields(FolderOptions& o, Visit visit) {
  visit("camera",
        o.camera,
        "source of the intrinsics: file (camera.yaml), or published values of a TUM camera");
  visit("depth", o.depth, "registration of depth images to the colour camera");
  visit("colour_focal",
        o.colour_focal,
        "focal length of the colour camera for depth: kinect [px]",
        GreaterThan{0});
  visit("pair_gap",
        o.pair_gap,
        "maximum time difference between paired depth and colour images [s]",
        Between{0, 1});
  visit("rate",
        o.rate,
        "frame rate of 7-Scenes recordings, which have no stamps [Hz]",
        GreaterThan{0});
  visit("every", o.every, "interval between used frames [frames]", Between{1});
  visit("first", o.first, "index of the first used frame, from 0", Between{0});
  visit("frames", o.frames, "maximum number of used frames; 0: all", Between{0});
}

/// Opens a recording in one of the layouts
/// - TUM RGB-D: rgb.txt and depth.txt, optionally groundtruth.txt and camera.yaml;
/// - 7-Scenes: frame-000000.color.png, .depth.png, .pose.txt and so on; default intrinsics of its
///   authors (585 px, principal point in the centre).
/// Throws InputError for another layout, an invalid list or unknown intrinsics. Missing or corrupt
/// images are detected when they are read.
std::unique_ptr<const RgbdSource> open_rgbd_folder(const std::filesystem::path& folder,
                                                   const FolderOptions& options);

}  // namespace loopbench::rgbd
