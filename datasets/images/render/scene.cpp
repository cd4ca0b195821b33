#include "datasets/images/render/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "datasets/core/hash.hpp"

namespace loopbench::rgbd {
namespace {

constexpr double kWallContrast = 1.0;
constexpr double kFloorContrast = 0.6;

std::array<std::size_t, 6> add_textures(Scene& scene,
                                        const Vector3& size,
                                        double contrast,
                                        std::uint64_t seed) {
  std::array<std::size_t, 6> skin{};
  for (std::size_t face = 0; face < 6; ++face) {
    const int axis = static_cast<int>(face / 2);
    const double share = axis == 2 ? kFloorContrast : 1.0;
    skin[face] = scene.textures.size();
    scene.textures.push_back(dead_leaves(
        size[(axis + 1) % 3], size[(axis + 2) % 3], contrast * share, hash_combine(seed, face)));
  }
  return skin;
}

/// Intersection of a ray with a block: distances and faces of entry and exit.
struct Crossing {
  double near, far;
  int near_face, far_face;
};

Crossing cross(const Block& block, const Vector3& origin, const Vector3& inverse) {
  Crossing out{
      -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), 0, 0};
  for (int axis = 0; axis < 3; ++axis) {
    double a = (block.low[axis] - origin[axis]) * inverse[axis];
    double b = (block.high[axis] - origin[axis]) * inverse[axis];
    int low = 2 * axis;
    int high = 2 * axis + 1;
    if (a > b) std::swap(a, b), std::swap(low, high);
    if (a > out.near) out.near = a, out.near_face = low;
    if (b < out.far) out.far = b, out.far_face = high;
  }
  return out;
}

Hit hit_of(
    const Block& block, int face, double depth, const Vector3& origin, const Vector3& direction) {
  const int axis = face / 2;
  const Vector3 point = origin + depth * direction - block.low;
  return {static_cast<float>(depth),
          static_cast<float>(std::abs(direction[axis]) / direction.norm()),
          static_cast<float>(point[(axis + 1) % 3]),
          static_cast<float>(point[(axis + 2) % 3]),
          face,
          block.skin[static_cast<std::size_t>(face)]};
}

// Brightness of the faces. It differs so that edges between faces of equal texture are visible.
constexpr std::array<float, 6> kLight{0.85f, 1.0f, 0.9f, 0.95f, 0.8f, 1.05f};

}  // namespace

Scene furnished_room(const Vector3& half_size, std::uint64_t seed) {
  Scene scene;
  const Vector3& h = half_size;
  scene.room = {-h, h, add_textures(scene, 2.0 * h, kWallContrast, seed)};
  const auto furnish = [&](const Vector3& low, const Vector3& size, std::uint64_t texture_seed) {
    scene.furniture.push_back(
        {low, low + size, add_textures(scene, size, kWallContrast, texture_seed)});
  };
  // Three pieces per wall, on the floor or hanging, at most 0.5 m deep.
  for (std::uint64_t k = 0; k < 12; ++k) {
    const auto draw = [&](std::uint64_t i) {
      return static_cast<double>(uniform(hash_combine(hash_combine(seed, 100 + k), i)));
    };
    const int wall = static_cast<int>(k % 4);
    const int across = wall < 2 ? 0 : 1;  // axis of the wall normal
    const int along = 1 - across;
    const double slot = static_cast<double>(k / 4);
    Vector3 size;
    size[across] = 0.2 + 0.3 * draw(0);
    size[along] = 0.4 + 0.5 * draw(1);
    size.z() = 0.4 + 0.8 * draw(2);
    Vector3 low;
    low[across] = wall % 2 == 0 ? -h[across] : h[across] - size[across];
    low[along] = -h[along] + (slot + 0.2 + 0.4 * draw(3)) * 2.0 * h[along] / 3.0;
    low[along] = std::min(low[along], h[along] - size[along]);
    low.z() =
        k / 4 == 1 ? h.z() - 0.3 - size.z() : -h.z();  // the second row hangs below the ceiling
    furnish(low, size, hash_combine(seed, 200 + k));
  }
  // Two identical cupboards at opposite walls.
  const Vector3 twin(0.5, 0.3, 1.6);
  furnish({0.55 * h.x(), -h.y(), -h.z()}, twin, hash_combine(seed, 300));
  furnish({-0.85 * h.x(), h.y() - twin.y(), -h.z()}, twin, hash_combine(seed, 300));
  return scene;
}

Hit cast_ray(const Scene& scene, const Vector3& origin, const Vector3& direction) {
  const Vector3 inverse =
      direction.cwiseInverse();  // infinite for parallel rays, which the slab test handles
  const Crossing walls = cross(scene.room, origin, inverse);
  double depth = walls.far;
  int face = walls.far_face;
  const Block* hit_block = &scene.room;
  for (const Block& block : scene.furniture) {
    const Crossing crossing = cross(block, origin, inverse);
    if (crossing.near > 0.0 && crossing.near < crossing.far && crossing.near < depth) {
      depth = crossing.near;
      face = crossing.near_face;
      hit_block = &block;
    }
  }
  return hit_of(*hit_block, face, depth, origin, direction);
}

RenderedImage render(const Scene& scene, const Camera& camera, const Pose& world_from_camera) {
  const Matrix3 R = world_from_camera.rotation.toRotationMatrix();
  const Vector3 right = R.col(0) / camera.fx;
  const Vector3 down = R.col(1) / camera.fy;
  RenderedImage out{Image<float>(camera.width, camera.height),
                    DepthImage(camera.width, camera.height),
                    Image<float>(camera.width, camera.height)};
  for (int y = 0; y < camera.height; ++y) {
    const Vector3 row = R.col(2) + (y - camera.cy) * down;
    for (int x = 0; x < camera.width; ++x) {
      const Vector3 ray = row + (x - camera.cx) * right;
      const Hit hit = cast_ray(scene, world_from_camera.translation, ray);
      const float footprint = hit.depth / (static_cast<float>(camera.fx) * hit.cosine);
      const float texel = sample(scene.textures[hit.skin], hit.u, hit.v, footprint);
      out.grey.at(x, y) = kLight[static_cast<std::size_t>(hit.face)] * texel;
      out.depth.at(x, y) = hit.depth;  // rays have unit length along the optical axis
      out.incidence_cosine.at(x, y) = hit.cosine;
    }
  }
  return out;
}

}  // namespace loopbench::rgbd
