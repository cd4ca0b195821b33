#include "datasets/images/folder/folder_source.hpp"

#include <fmt/format.h>

#include "datasets/images/folder/layouts.hpp"
#include "datasets/images/folder/read_image.hpp"
#include "datasets/images/folder/register_depth.hpp"

namespace loopbench::rgbd {
namespace {

namespace fs = std::filesystem;

constexpr std::uint16_t kNoDepth = 65535;  // invalid depth in 7-Scenes; TUM uses 0

class FolderSource final : public RgbdSource {
 public:
  FolderSource(Recording recording, bool registered, double colour_focal)
      : recording_(std::move(recording)),
        registered_(registered),
        kinect_(unregistered_kinect(colour_focal)) {
    if (registered_) return;
    recording_.camera = kinect_.colour;
    const Pose depth_from_colour = kinect_.colour_from_depth.inverse();
    for (StampedPose& pose : recording_.reference) {
      pose.world_from_body = normalized(pose.world_from_body * depth_from_colour);
    }
  }

  Camera camera() const override { return recording_.camera; }
  std::size_t size() const override { return recording_.frames.size(); }
  double stamp(std::size_t index) const override { return recording_.frames.at(index).stamp; }
  const Trajectory& reference() const override { return recording_.reference; }

  std::optional<RgbdFrame> read(std::size_t index, std::string& why) const override {
    const ImagePair& pair = recording_.frames.at(index);
    try {
      RgbdFrame out;
      out.grey = read_grey(pair.grey);
      require_size(out.grey.width, out.grey.height, pair.grey);
      const Image<std::uint16_t> raw = read_depth(pair.depth);
      require_size(raw.width, raw.height, pair.depth);
      out.depth = registered_ ? metres(raw) : register_depth(metres(raw), kinect_);
      return out;
    } catch (const InputError& error) {
      why = error.what();
      return std::nullopt;
    }
  }

  Provenance provenance() const override {
    Provenance out;
    out.sensor = "RGB-D";
    for (const fs::path& list : recording_.lists) out.inputs.push_back({list});
    for (const ImagePair& pair : recording_.frames) {
      out.inputs.push_back({pair.grey});
      out.inputs.push_back({pair.depth});
    }
    out.notes = recording_.notes;
    out.reference = recording_.reference_file;
    return out;
  }

 private:
  void require_size(int width, int height, const fs::path& file) const {
    const Camera& camera = recording_.camera;
    if (width == camera.width && height == camera.height) return;
    throw input_error(
        file.string(),
        0,
        fmt::format("has {} x {} pixels, expected {} x {} as in the camera intrinsics",
                    width,
                    height,
                    camera.width,
                    camera.height));
  }

  DepthImage metres(const Image<std::uint16_t>& raw) const {
    DepthImage out(raw.width, raw.height);
    for (std::size_t i = 0; i < raw.pixels.size(); ++i) {
      if (raw.pixels[i] == kNoDepth) continue;
      out.pixels[i] =
          static_cast<float>(static_cast<double>(raw.pixels[i]) / recording_.camera.depth_scale);
    }
    return out;
  }

  Recording recording_;
  bool registered_;
  CameraPair kinect_;
};

std::vector<ImagePair> selected_frames(const std::vector<ImagePair>& all, const FolderOptions& o) {
  std::vector<ImagePair> out;
  const auto every = static_cast<std::size_t>(o.every);
  for (auto k = static_cast<std::size_t>(o.first); k < all.size(); k += every) {
    if (o.frames > 0 && out.size() == static_cast<std::size_t>(o.frames)) break;
    out.push_back(all[k]);
  }
  return out;
}

}  // namespace

std::unique_ptr<const RgbdSource> open_rgbd_folder(const fs::path& folder,
                                                   const FolderOptions& options) {
  const bool tum = fs::exists(folder / "rgb.txt");
  if (!tum && !is_seven_scenes(folder)) {
    throw input_error(folder.string(),
                      0,
                      "contains no recording, expected rgb.txt and depth.txt (TUM RGB-D) or "
                      "frame-000000.color.png (7-Scenes)");
  }
  Recording recording =
      tum ? read_tum_layout(folder, options) : read_seven_scenes_layout(folder, options);
  const bool registered =
      options.depth == DepthGeometry::automatic ? tum : options.depth == DepthGeometry::registered;
  const std::size_t all = recording.frames.size();
  recording.frames = selected_frames(recording.frames, options);
  if (recording.frames.empty()) {
    throw OptionError(
        "first",
        fmt::format("first = {}: expected first < {}, the number of frames", options.first, all));
  }
  return std::make_unique<FolderSource>(std::move(recording), registered, options.colour_focal);
}

}  // namespace loopbench::rgbd
