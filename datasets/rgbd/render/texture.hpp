/// Random textures with corners at all scales.
#pragma once

#include <cstdint>
#include <vector>

#include "datasets/rgbd/image.hpp"

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

}  // namespace loopbench::rgbd
