/// Writes a rendered room to disk in TUM RGB-D layout.
#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>

#include "datasets/formats/formats.hpp"
#include "datasets/images/folder/folder_source.hpp"
#include "datasets/images/render/rendered_room.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench {

using namespace rgbd;

inline RenderOptions small_room(double laps) { return {.width = 160, .rate = 8.0, .laps = laps}; }

inline std::string camera_yaml(const Camera& c) {
  return fmt::format(
      "width: {}\nheight: {}\nfx: {}\nfy: {}\ncx: {}\ncy: {}\n"
      "distortion: [0, 0, 0, 0, 0]\ndepth_scale: {}\n",
      c.width,
      c.height,
      c.fx,
      c.fy,
      c.cx,
      c.cy,
      c.depth_scale);
}

/// Writes rgb/, depth/, both lists, camera.yaml and groundtruth.txt.
inline void write_recording(const TemporaryFolder& folder, const RgbdSource& source) {
  const auto make = [&](const char* name) {
    std::filesystem::create_directories(folder.path() / name);
  };
  make("rgb");
  make("depth");
  std::string colour = "# color images\n";
  std::string depth = "# depth maps\n";
  std::string why;
  for (std::size_t i = 0; i < source.size(); ++i) {
    RgbdFrame frame = *source.read(i, why);
    const cv::Mat grey(frame.grey.height, frame.grey.width, CV_8U, frame.grey.pixels.data());
    const cv::Mat metres(frame.depth.height, frame.depth.width, CV_32F, frame.depth.pixels.data());
    cv::Mat millimetres;
    metres.convertTo(millimetres, CV_16U, source.camera().depth_scale);
    const std::string name = fmt::format("{:04}.png", i);
    cv::imwrite((folder.path() / "rgb" / name).string(), grey);
    cv::imwrite((folder.path() / "depth" / name).string(), millimetres);
    colour += fmt::format("{:.6f} rgb/{}\n", source.stamp(i), name);
    depth += fmt::format("{:.6f} depth/{}\n", source.stamp(i) + 0.004, name);
  }
  folder.file("rgb.txt", colour);
  folder.file("depth.txt", depth);
  folder.file("camera.yaml", camera_yaml(source.camera()));
  write_tum(folder.path() / "groundtruth.txt", source.reference());
}

/// A folder with the recording of a room, five frames.
class RecordedRoom : public testing::Test {
 protected:
  RecordedRoom() { write_recording(folder_, *room_); }

  std::unique_ptr<const RgbdSource> open(const FolderOptions& options = {}) const {
    return open_rgbd_folder(folder_.path(), options);
  }
  std::string refusal() const {
    return refusal_of([&] { open(); });
  }
  /// The reason why frame `index` cannot be read; "" if it can.
  std::string unreadable(std::size_t index) const {
    std::string why;
    return open()->read(index, why) ? "" : why;
  }

  std::unique_ptr<const RgbdSource> room_ = rendered_room(small_room(0.01));
  TemporaryFolder folder_;
};

}  // namespace loopbench
