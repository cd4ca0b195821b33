#include "datasets/rgbd/render/sensor.hpp"

#include <algorithm>
#include <cmath>

#include "datasets/hash.hpp"

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

}  // namespace

RgbdFrame apply_sensor_model(const RenderedImage& ideal,
                             const Camera& camera,
                             const Pose& begin_from_end,
                             double stamp,
                             std::uint64_t frame,
                             const RenderOptions& o) {
  const int w = camera.width;
  const int h = camera.height;
  RgbdFrame out{GreyImage(w, h), DepthImage(w, h)};
  const std::uint64_t seed = mixed(static_cast<std::uint64_t>(o.seed), 0x5e4505 + frame);
  const double gain = 1.0 + kBrightness * std::sin(0.9 * stamp) +
                      0.1 * kBrightness * static_cast<double>(approximate_normal(mixed(seed, 1u)));
  const Pose end_from_begin = begin_from_end.inverse();
  const double diagonal = 0.25 * (w * w + h * h);
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      const auto pixel = static_cast<std::uint64_t>(y * w + x);
      const std::uint64_t draw = mixed(seed, 16 + 2 * pixel);
      const float z = ideal.depth.at(x, y);

      const float light =
          motion_blurred(ideal.grey, image_motion(camera, end_from_begin, x, y, z), x, y);
      const double dx = x - camera.cx;
      const double dy = y - camera.cy;
      const double corner = 1.0 - 0.25 * (dx * dx + dy * dy) / diagonal;
      const double grey =
          light * gain * corner + kGreyNoise * static_cast<double>(approximate_normal(draw));
      out.grey.at(x, y) = static_cast<std::uint8_t>(std::clamp(grey + 0.5, 0.0, 255.0));

      const std::uint64_t chance = mixed(seed, 17 + 2 * pixel);
      const int u = std::clamp(x + static_cast<int>(chance % 3) - 1, 0, w - 1);
      const int v = std::clamp(y + static_cast<int>((chance / 3) % 3) - 1, 0, h - 1);
      const bool with_noise = o.depth_noise > 0.0;
      const float exact = with_noise ? ideal.depth.at(u, v) : z;
      const auto patch = static_cast<std::uint64_t>((y / kPatch) * w + x / kPatch);
      const float hole = 0.015f * static_cast<float>(o.dropouts);
      const bool dropped =
          o.dropouts > 0.0 &&
          (ideal.incidence_cosine.at(x, y) < kGrazing || beside_edge(ideal.depth, x, y) ||
           uniform(mixed(seed ^ 0xd409, patch)) < hole || uniform(mixed(chance)) < hole);
      if (dropped || exact < kMinDepth || exact > kMaxDepth) continue;
      const float sigma = kNoise * static_cast<float>(o.depth_noise);
      float measured = exact + sigma * exact * exact * approximate_normal(mixed(chance, 3u));
      if (with_noise) {
        const float eighths = std::round(8.0f * kKinectFocal * kBaseline / measured);
        measured = 8.0f * kKinectFocal * kBaseline / eighths;
      }
      out.depth.at(x, y) = std::round(measured * 1000.0f) / 1000.0f;
    }
  }
  return out;
}

}  // namespace loopbench::rgbd
