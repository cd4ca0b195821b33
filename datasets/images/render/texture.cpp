// Random textures with corners at all scales, and their mipmaps.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "datasets/core/hash.hpp"
#include "datasets/images/render/scene.hpp"

namespace loopbench::rgbd {
namespace {

constexpr double kSmallest = 0.015;  // [m]
constexpr double kLargest = 0.6;     // [m]
constexpr double kLayers = 2.0;      // mean number of leaves per point

struct Leaf {
  double x, y;            // centre [texels]
  double cosine, sine;    // of the rotation angle
  double half_w, half_h;  // [texels]
  bool disc;
  float grey;
};

void draw_leaf(GreyImage& image, const Leaf& leaf) {
  const double radius = std::hypot(leaf.half_w, leaf.half_h);
  const int x0 = std::max(0, static_cast<int>(leaf.x - radius));
  const int x1 = std::min(image.width - 1, static_cast<int>(leaf.x + radius));
  const int y0 = std::max(0, static_cast<int>(leaf.y - radius));
  const int y1 = std::min(image.height - 1, static_cast<int>(leaf.y + radius));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const double dx = x - leaf.x;
      const double dy = y - leaf.y;
      const double a = (leaf.cosine * dx + leaf.sine * dy) / leaf.half_w;
      const double b = (leaf.cosine * dy - leaf.sine * dx) / leaf.half_h;
      const bool inside = leaf.disc ? a * a + b * b < 1.0 : std::abs(a) < 1.0 && std::abs(b) < 1.0;
      if (inside) image.at(x, y) = static_cast<std::uint8_t>(leaf.grey);
    }
  }
}

GreyImage halved(const GreyImage& image) {
  GreyImage out(std::max(1, image.width / 2), std::max(1, image.height / 2));
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      const int x1 = std::min(2 * x + 1, image.width - 1);
      const int y1 = std::min(2 * y + 1, image.height - 1);
      const int sum =
          image.at(2 * x, 2 * y) + image.at(x1, 2 * y) + image.at(2 * x, y1) + image.at(x1, y1);
      out.at(x, y) = static_cast<std::uint8_t>((sum + 2) / 4);
    }
  }
  return out;
}

float bilinear(const GreyImage& image, float x, float y) {
  const float fx = std::clamp(x, 0.0f, static_cast<float>(image.width - 1));
  const float fy = std::clamp(y, 0.0f, static_cast<float>(image.height - 1));
  const int x0 = static_cast<int>(fx);
  const int y0 = static_cast<int>(fy);
  const int x1 = std::min(x0 + 1, image.width - 1);
  const int y1 = std::min(y0 + 1, image.height - 1);
  const float a = fx - static_cast<float>(x0);
  const float b = fy - static_cast<float>(y0);
  const float top = (1.0f - a) * image.at(x0, y0) + a * image.at(x1, y0);
  const float bottom = (1.0f - a) * image.at(x0, y1) + a * image.at(x1, y1);
  return (1.0f - b) * top + b * bottom;
}

}  // namespace

Texture dead_leaves(double width, double height, double contrast, std::uint64_t seed) {
  Texture out;
  const double scale = out.texels_per_metre;
  GreyImage image(std::max(1, static_cast<int>(width * scale)),
                  std::max(1, static_cast<int>(height * scale)),
                  128);
  const double a = 1.0 / (kSmallest * kSmallest);
  const double b = 1.0 / (kLargest * kLargest);
  const double mean_area = 2.0 * std::log(kLargest / kSmallest) / (a - b);
  const auto count = static_cast<std::uint64_t>(kLayers * width * height / mean_area);
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto draw = [&](std::uint64_t k) {
      return static_cast<double>(uniform(hash_combine(seed, 8 * i + k)));
    };
    const double side = scale / std::sqrt(a - draw(0) * (a - b));
    const double angle = draw(1) < 0.5 ? 0.0 : std::numbers::pi * draw(2);
    const double shape = 0.5 + draw(3);
    draw_leaf(image,
              {draw(4) * image.width,
               draw(5) * image.height,
               std::cos(angle),
               std::sin(angle),
               0.5 * side * shape,
               0.5 * side / shape,
               hash_combine(seed, 8 * i + 6) % 3 == 0,
               static_cast<float>(128.0 + contrast * 110.0 * (2.0 * draw(7) - 1.0))});
  }
  out.levels.push_back(std::move(image));
  while (std::min(out.levels.back().width, out.levels.back().height) > 4) {
    out.levels.push_back(halved(out.levels.back()));
  }
  return out;
}

float sample(const Texture& texture, float u, float v, float footprint) {
  const float last = static_cast<float>(texture.levels.size() - 1);
  const float texels = std::max(footprint * texture.texels_per_metre, 1.0f);
  const float level = std::min(std::log2(texels), last);
  const auto fine = static_cast<std::size_t>(level);
  const std::size_t coarse = std::min(fine + 1, texture.levels.size() - 1);
  const float share = level - static_cast<float>(fine);
  const auto sample_level = [&](std::size_t k) {
    const float scale = texture.texels_per_metre / static_cast<float>(std::size_t{1} << k);
    return bilinear(texture.levels[k], u * scale - 0.5f, v * scale - 0.5f);
  };
  return (1.0f - share) * sample_level(fine) + share * sample_level(coarse);
}

}  // namespace loopbench::rgbd
