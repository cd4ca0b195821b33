/// Scene of a furnished room made of axis-aligned boxes with random textures, and its rendering
/// without sensor noise.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "datasets/core/pose.hpp"
#include "datasets/core/so3.hpp"
#include "datasets/images/frames/camera.hpp"
#include "datasets/images/frames/image.hpp"

namespace loopbench::rgbd {

/// An image with its mipmap levels, finest first.
struct Texture {
  float texels_per_metre = 200.0f;
  std::vector<GreyImage> levels = {};
};

/// Dead leaves texture: overlapping opaque rectangles and discs, with side s of density s^-3
/// between 15 mm and 0.6 m; a model with statistics similar to natural images (Lee, Mumford and
/// Huang 2001). `width` and `height` [m]; `contrast` 0..1 scales grey values about their mean.
/// O(texels).
Texture dead_leaves(double width, double height, double contrast, std::uint64_t seed);

/// Grey value at (u, v) [m], interpolated between the two levels with texel sizes closest to
/// `footprint` [m] (trilinear filtering).
float sample(const Texture& texture, float u, float v, float footprint);

struct Block {
  Vector3 low;                      ///< [m]
  Vector3 high;                     ///< [m]
  std::array<std::size_t, 6> skin;  ///< texture index of faces -x, +x, -y, +y, -z, +z
};

struct Scene {
  Block room;
  std::vector<Block> furniture = {};
  std::vector<Texture> textures = {};
};

/// Creates a room centred at the origin with furniture along the walls. `half_size` [m]. Two
/// cupboards are identical, to provoke false loop candidates. Deterministic for a seed.
Scene furnished_room(const Vector3& half_size, std::uint64_t seed);

struct Hit {
  float depth = 0.0f;    ///< distance along the ray in multiples of the direction vector [-]
  float cosine = 0.0f;   ///< cosine of the angle between ray and surface normal [-]
  float u = 0.0f;        ///< first coordinate on the surface [m]
  float v = 0.0f;        ///< second coordinate on the surface [m]
  int face = 0;          ///< face index 0..5
  std::size_t skin = 0;  ///< texture index
};

/// First intersection of a ray that starts inside the room. O(furniture).
Hit cast_ray(const Scene& scene, const Vector3& origin, const Vector3& direction);

struct RenderedImage {
  Image<float> grey;              ///< 0..255
  DepthImage depth;               ///< depth of every pixel [m]
  Image<float> incidence_cosine;  ///< cosine of the angle between ray and surface normal [-]
};

/// Casts one ray through the centre of each pixel. O(pixels * furniture).
RenderedImage render(const Scene& scene, const Camera& camera, const Pose& world_from_camera);

}  // namespace loopbench::rgbd
