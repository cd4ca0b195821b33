/// A recording on disk: TUM RGB-D, 7-Scenes or ICL-NUIM layout.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "datasets/core/fields.hpp"
#include "datasets/rgbd/rgbd_source.hpp"

namespace loopbench {

/// Where the intrinsics come from. `automatic`: camera.yaml in the folder, else the published ones
/// when the folder's name holds freiburg1 | fr1 and so on.
enum class CameraChoice { automatic, file, fr1, fr2, fr3 };
inline auto choices(CameraChoice) {
  return std::array{std::pair{"auto", CameraChoice::automatic},
                    std::pair{"file", CameraChoice::file},
                    std::pair{"fr1", CameraChoice::fr1},
                    std::pair{"fr2", CameraChoice::fr2},
                    std::pair{"fr3", CameraChoice::fr3}};
}

/// Whether depth pixels already are colour pixels. `automatic`: no in 7-Scenes, else yes.
/// `kinect`: no; they are brought there by unregistered_kinect(), whose intrinsics replace the
/// folder's, and the reference, which is the depth camera's, is moved to the colour camera.
enum class DepthGeometry { automatic, registered, kinect };
inline auto choices(DepthGeometry) {
  return std::array{std::pair{"auto", DepthGeometry::automatic},
                    std::pair{"registered", DepthGeometry::registered},
                    std::pair{"kinect", DepthGeometry::kinect}};
}

struct FolderOptions {
  DepthGeometry depth = DepthGeometry::automatic;
  CameraChoice camera = CameraChoice::automatic;
  double pair_gap = 0.02;  ///< [s]
  double rate = 30.0;      ///< [Hz]
  std::int64_t every = 1;
  std::int64_t first = 0;
  std::int64_t frames = 0;
};

template <class Visit>
void fields(FolderOptions& o, Visit visit) {
  visit("camera", o.camera, "intrinsics: camera.yaml, or those published for TUM's cameras");
  visit("depth", o.depth, "whether depth pixels are colour pixels, or how they become so");
  visit("pair_gap", o.pair_gap, "farthest that depth and colour lie apart [s]", Between{0, 1});
  visit("rate", o.rate, "of a 7-Scenes or ICL-NUIM folder, which has no stamps [Hz]", Above{0});
  visit("every", o.every, "take each so many-th frame", Between{1});
  visit("first", o.first, "frame to begin with", Between{0});
  visit("frames", o.frames, "take at most so many; 0: all", Between{0});
}

/// `folder` holds rgb.txt and depth.txt (TUM), with groundtruth.txt and camera.yaml if there are;
/// or frame-000000.color.png, .depth.png, .pose.txt and so on (7-Scenes; intrinsics as its authors
/// give them, 585 px about the middle); or associations.txt and no rgb.txt, with *.gt.freiburg if
/// there is (ICL-NUIM's "TUM compatible PNGs"; its published intrinsics, y turned down). Throws
/// InputError: no such layout, a broken list, intrinsics unknown. An image that is missing or
/// broken is found only when it is read.
std::unique_ptr<const RgbdSource> open_rgbd_folder(const std::filesystem::path& folder,
                                                   const FolderOptions& options);

}  // namespace loopbench
