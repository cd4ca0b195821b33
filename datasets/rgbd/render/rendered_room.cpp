#include "datasets/rgbd/render/rendered_room.hpp"

#include <cmath>

#include "datasets/core/params.hpp"
#include "datasets/hash.hpp"
#include "datasets/rgbd/render/scene.hpp"
#include "datasets/rgbd/render/sensor.hpp"
#include "datasets/simulated/path.hpp"

namespace loopbench::rgbd {
namespace {

// Increment with any change of the rendered images, to invalidate caches.
constexpr std::uint64_t kRenderVersion = 1;
constexpr double kExposureTime = 0.012;   // of motion blur [s]
const Vector3 kHalfRoom(2.7, 2.4, 1.35);  // [m]; the path is within +-1.3 x +-1.1 x +-0.3 m

/// Rotation from camera axes (x right, y down, z forward) to body axes (x forward, y left, z up).
Pose body_from_camera() {
  Matrix3 R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {Rotation(R), Vector3::Zero()};
}

Camera camera_of(const RenderOptions& options) {
  Camera camera;
  camera.width = static_cast<int>(options.width);
  camera.height = camera.width * 3 / 4;
  camera.fx = camera.fy = 0.82 * camera.width;
  camera.cx = 0.5 * (camera.width - 1);
  camera.cy = 0.5 * (camera.height - 1);
  camera.depth_scale = 1000.0;
  return camera;
}

class RenderedRoom final : public RgbdSource {
 public:
  explicit RenderedRoom(const RenderOptions& options)
      : options_(options),
        camera_(camera_of(options)),
        path_(room_path()),
        scene_(furnished_room(kHalfRoom, static_cast<std::uint64_t>(options.seed))) {
    const double seconds = options.laps * path_.duration;
    size_ = static_cast<std::size_t>(seconds * options.rate * (1.0 + 1e-12)) + 1;
    const double rate = 4.0 * options.rate;
    for (std::size_t k = 0; k < 4 * (size_ - 1) + 1; ++k) {
      const double time = static_cast<double>(k) / rate;
      reference_.push_back({time, pose(time)});
    }
  }

  Camera camera() const override { return camera_; }
  std::size_t size() const override { return size_; }
  double stamp(std::size_t index) const override {
    return static_cast<double>(index) / options_.rate;
  }
  const Trajectory& reference() const override { return reference_; }

  std::optional<RgbdFrame> read(std::size_t index, std::string&) const override {
    const double time = stamp(index);
    const Pose now = pose(time);
    const Pose begin = pose(std::max(0.0, time - 0.5 * kExposureTime));
    const Pose end = pose(time + 0.5 * kExposureTime);
    const RenderedImage ideal = render(scene_, camera_, now);
    return apply_sensor_model(ideal, camera_, begin.inverse() * end, time, index, options_);
  }

  std::uint64_t content() const override {
    return mixed(mixed(kRenderVersion, "rendered_room"), to_text(echo(options_)));
  }

  Provenance provenance() const override {
    Provenance out;
    out.sensor = "RGB-D, rendered";
    out.licence = "none needed";
    // Room, textures and noise depend on the seed only, so that they are shared by all options.
    out.noise = "rendered_room; seed " + std::to_string(options_.seed);
    return out;
  }

 private:
  Pose pose(double time) const { return normalized(path_.at(time) * body_from_camera()); }

  RenderOptions options_;
  Camera camera_;
  Path path_;
  Scene scene_;
  std::size_t size_ = 0;
  Trajectory reference_;
};

}  // namespace

std::unique_ptr<const RgbdSource> rendered_room(const RenderOptions& options) {
  return std::make_unique<RenderedRoom>(options);
}

}  // namespace loopbench::rgbd
