/// A furnished room: one box seen from inside, others seen from outside, all parallel to the axes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "datasets/core/so3.hpp"
#include "datasets/rgbd/render/texture.hpp"

namespace loopbench {

struct Block {
  Vector3 low;                      ///< [m]
  Vector3 high;                     ///< [m]
  std::array<std::size_t, 6> skin;  ///< texture of faces -x, +x, -y, +y, -z, +z
};

struct Scene {
  Block room;
  std::vector<Block> furniture = {};
  std::vector<Texture> textures = {};
};

/// Walls, floor and ceiling around `middle` with furniture along the walls; two cupboards look the
/// same, to tempt a place recogniser. Half sizes [m]. Everything follows from the seed.
Scene furnished_room(const Vector3& half_size, std::uint64_t seed);

struct Hit {
  float depth = 0.0f;    ///< along the ray in units of its direction's length
  float cosine = 0.0f;   ///< of the angle at which the surface is met
  float u = 0.0f;        ///< on the surface [m]
  float v = 0.0f;        ///< [m]
  int face = 0;          ///< which of the six
  std::size_t skin = 0;  ///< texture
};

/// The first surface a ray from inside the room meets. O(furniture).
Hit cast(const Scene& scene, const Vector3& origin, const Vector3& direction);

}  // namespace loopbench
