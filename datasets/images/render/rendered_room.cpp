#include "datasets/images/render/rendered_room.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "datasets/core/hash.hpp"
#include "datasets/core/pose.hpp"
#include "datasets/images/frames/camera.hpp"
#include "datasets/images/frames/image.hpp"
#include "datasets/images/render/scene.hpp"
#include "datasets/simulated/path.hpp"

namespace loopbench::rgbd {
namespace {

constexpr int kTaps = 5;               // samples along the motion blur
constexpr double kGreyNoise = 3.0;     // standard deviation [grey levels]
constexpr double kBrightness = 0.25;   // relative amplitude of slow changes [-]
constexpr float kMinDepth = 0.5f;      // [m]
constexpr float kMaxDepth = 4.5f;      // [m]
constexpr float kNoise = 1.425e-3f;    // [m at 1 m]
constexpr float kBaseline = 0.075f;    // projector to camera [m]
constexpr float kKinectFocal = 580.f;  // [px] at an image width of 640 px
constexpr float kGrazing = 0.17f;      // cosine of 80 degrees
constexpr int kPatch = 8;              // side of a random hole [px]

Eigen::Vector2d image_motion(
    const Camera& camera, const Pose& end_from_begin, int x, int y, float z) {
  const Vector3 later = end_from_begin * camera.back_project(x, y, static_cast<double>(z));
  if (later.z() < 0.1) return Eigen::Vector2d::Zero();
  return camera.project(later) - Eigen::Vector2d(x, y);
}

float motion_blurred(const Image<float>& grey, const Eigen::Vector2d& motion, int x, int y) {
  if (motion.squaredNorm() < 0.01) return grey.at(x, y);
  float sum = 0.0f;
  for (int k = 0; k < kTaps; ++k) {
    const double share = static_cast<double>(k) / (kTaps - 1) - 0.5;
    const int u =
        std::clamp(static_cast<int>(std::lround(x + share * motion.x())), 0, grey.width - 1);
    const int v =
        std::clamp(static_cast<int>(std::lround(y + share * motion.y())), 0, grey.height - 1);
    sum += grey.at(u, v);
  }
  return sum / kTaps;
}

/// Whether a pixel lies in the shadow of the projector, behind a depth edge on its left.
bool beside_edge(const DepthImage& depth, int x, int y) {
  const float z = depth.at(x, y);
  const int left = std::max(x - 2, 0);
  return z - depth.at(left, y) > 0.08f * z;
}

/// Applies sensor effects to an ideal image.
/// Grey image: motion blur over the exposure (`begin_from_end` is the camera motion during it),
/// vignetting, a gain that varies slowly in time, noise and rounding.
/// Depth image: noise with standard deviation 1.425 mm/m^2 z^2 (Khoshelham and Elberink 2012),
/// disparity in steps of 1/8 pixel, rounding to millimetres and a random offset of at most one
/// pixel. Depth is missing below 0.5 m, above 4.5 m, on slanted surfaces, in the projector's shadow
/// next to depth edges and in random patches.
/// All draws are determined by `frame` and the seed. O(pixels).
RgbdFrame apply_sensor_model(const RenderedImage& ideal,
                             const Camera& camera,
                             const Pose& begin_from_end,
                             double stamp,
                             std::uint64_t frame,
                             const RenderOptions& o) {
  const int w = camera.width;
  const int h = camera.height;
  RgbdFrame out{GreyImage(w, h), DepthImage(w, h)};
  const std::uint64_t seed = hash_combine(static_cast<std::uint64_t>(o.seed), 0x5e4505 + frame);
  const double gain =
      1.0 + kBrightness * std::sin(0.9 * stamp) +
      0.1 * kBrightness * static_cast<double>(approximate_normal(hash_combine(seed, 1u)));
  const Pose end_from_begin = begin_from_end.inverse();
  const double diagonal = 0.25 * (w * w + h * h);
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      const auto pixel = static_cast<std::uint64_t>(y * w + x);
      const std::uint64_t draw = hash_combine(seed, 16 + 2 * pixel);
      const float z = ideal.depth.at(x, y);

      const float light =
          motion_blurred(ideal.grey, image_motion(camera, end_from_begin, x, y, z), x, y);
      const double dx = x - camera.cx;
      const double dy = y - camera.cy;
      const double corner = 1.0 - 0.25 * (dx * dx + dy * dy) / diagonal;
      const double grey =
          light * gain * corner + kGreyNoise * static_cast<double>(approximate_normal(draw));
      out.grey.at(x, y) = static_cast<std::uint8_t>(std::clamp(grey + 0.5, 0.0, 255.0));

      const std::uint64_t chance = hash_combine(seed, 17 + 2 * pixel);
      const int u = std::clamp(x + static_cast<int>(chance % 3) - 1, 0, w - 1);
      const int v = std::clamp(y + static_cast<int>((chance / 3) % 3) - 1, 0, h - 1);
      const bool with_noise = o.depth_noise > 0.0;
      const float exact = with_noise ? ideal.depth.at(u, v) : z;
      const auto patch = static_cast<std::uint64_t>((y / kPatch) * w + x / kPatch);
      const float hole = 0.015f * static_cast<float>(o.dropouts);
      const bool dropped =
          o.dropouts > 0.0 &&
          (ideal.incidence_cosine.at(x, y) < kGrazing || beside_edge(ideal.depth, x, y) ||
           uniform(hash_combine(seed ^ 0xd409, patch)) < hole ||
           uniform(hash_combine(chance)) < hole);
      if (dropped || exact < kMinDepth || exact > kMaxDepth) continue;
      const float sigma = kNoise * static_cast<float>(o.depth_noise);
      float measured = exact + sigma * exact * exact * approximate_normal(hash_combine(chance, 3u));
      if (with_noise) {
        const float eighths = std::round(8.0f * kKinectFocal * kBaseline / measured);
        measured = 8.0f * kKinectFocal * kBaseline / eighths;
      }
      out.depth.at(x, y) = std::round(measured * 1000.0f) / 1000.0f;
    }
  }
  return out;
}

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
