#include "datasets/images/features/matching.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "datasets/images/features/features.hpp"

namespace loopbench::rgbd {
namespace {

/// Number of bits set, without the POPCNT instruction, which is not available on all machines.
std::uint64_t bits_set(std::uint64_t x) {
  x -= (x >> 1) & 0x5555555555555555u;
  x = (x & 0x3333333333333333u) + ((x >> 2) & 0x3333333333333333u);
  return (((x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fu) * 0x0101010101010101u) >> 56;
}

}  // namespace

float descriptor_distance(const Features& a, std::size_t i, const Features& b, std::size_t k) {
  const std::uint8_t* p = a.descriptor(i);
  const std::uint8_t* q = b.descriptor(k);
  const auto bytes = static_cast<std::size_t>(a.bytes);
  if (a.binary) {
    std::uint64_t sum = 0;
    for (std::size_t at = 0; at < bytes; at += 8) {
      std::uint64_t x = 0;
      std::uint64_t y = 0;
      const std::size_t count = std::min<std::size_t>(8, bytes - at);
      std::memcpy(&x, p + at, count);
      std::memcpy(&y, q + at, count);
      sum += bits_set(x ^ y);
    }
    return static_cast<float>(sum) / static_cast<float>(8 * bytes);
  }
  int sum = 0;
  for (std::size_t at = 0; at < bytes; ++at) {
    const int difference = p[at] - q[at];
    sum += difference * difference;
  }
  return std::sqrt(static_cast<float>(sum)) / 1024.0f;  // SIFT descriptors have norm 512
}

namespace {

constexpr int kCell = 16;                 // [px]
constexpr int kOctaveSlack = 2;           // maximum scale change between frames
constexpr double kMinVisibleDepth = 0.1;  // minimum depth of a visible point [m]

/// Features indexed by image cells.
class Grid {
 public:
  Grid(const Features& features, const Camera& camera)
      : columns_(camera.width / kCell + 1), rows_(camera.height / kCell + 1) {
    cells_.resize(static_cast<std::size_t>(columns_ * rows_));
    for (std::size_t i = 0; i < features.size(); ++i) {
      const Feature& point = features.points[i];
      cells_[cell(column(point.u), row(point.v))].push_back(i);
    }
  }

  template <class Visit>
  void around(double u, double v, double radius, const Visit& visit) const {
    const int last = column(u + radius);
    const int bottom = row(v + radius);
    for (int y = row(v - radius); y <= bottom; ++y) {
      for (int x = column(u - radius); x <= last; ++x) {
        for (const std::size_t i : cells_[cell(x, y)]) visit(i);
      }
    }
  }

 private:
  int column(double u) const { return std::clamp(static_cast<int>(u) / kCell, 0, columns_ - 1); }
  int row(double v) const { return std::clamp(static_cast<int>(v) / kCell, 0, rows_ - 1); }
  std::size_t cell(int x, int y) const { return static_cast<std::size_t>(y * columns_ + x); }

  int columns_;
  int rows_;
  std::vector<std::vector<std::size_t>> cells_;
};

}  // namespace

std::vector<Match> match_guided(const std::vector<MapPoint>& points,
                                const Features& descriptors,
                                const Features& features,
                                const Camera& camera,
                                const Pose& world_from_camera,
                                double radius) {
  constexpr float kNone = std::numeric_limits<float>::infinity();
  const Grid grid(features, camera);
  const Pose camera_from_world = world_from_camera.inverse();
  struct Owner {
    std::size_t point = 0;
    float distance = kNone;
  };
  std::vector<Owner> owners(features.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Vector3 in_camera = camera_from_world * points[p].in_world;
    if (in_camera.z() < kMinVisibleDepth) continue;
    const Eigen::Vector2d at = camera.project(in_camera);
    if (at.x() < -radius || at.y() < -radius || at.x() > camera.width + radius ||
        at.y() > camera.height + radius) {
      continue;
    }
    float best = kNone;
    float second = kNone;
    std::size_t best_feature = 0;
    const double reach = radius + points[p].octave;
    grid.around(at.x(), at.y(), reach, [&](std::size_t f) {
      const Feature& feature = features.points[f];
      const double du = static_cast<double>(feature.u) - at.x();
      const double dv = static_cast<double>(feature.v) - at.y();
      if (du * du + dv * dv > reach * reach) return;
      if (std::abs(feature.octave - points[p].octave) > kOctaveSlack) return;
      const float distance = descriptor_distance(descriptors, points[p].row, features, f);
      if (distance < best) {
        second = best;
        best = distance;
        best_feature = f;
      } else {
        second = std::min(second, distance);
      }
    });
    if (best > static_cast<float>(kMaxDistance) || best > static_cast<float>(kMaxRatio) * second) {
      continue;
    }
    if (best < owners[best_feature].distance) owners[best_feature] = {p, best};
  }
  std::vector<Match> out;
  for (std::size_t f = 0; f < owners.size(); ++f) {
    if (owners[f].distance < kNone) out.push_back({owners[f].point, f, owners[f].distance});
  }
  return out;
}

}  // namespace loopbench::rgbd
