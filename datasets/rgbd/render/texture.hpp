/// Pictures to paint surfaces with: full of corners at every scale and nowhere the same.
#pragma once

#include <cstdint>
#include <vector>

#include "datasets/rgbd/image.hpp"

namespace loopbench {

/// A picture with its halved copies, finest first.
struct Texture {
  float texels_per_metre = 200.0f;
  std::vector<GreyImage> levels = {};
};

/// Dead leaves: opaque rectangles and discs of all sizes thrown on each other (side s with density
/// s^-3 between 15 mm and 0.6 m), the model whose statistics come nearest to natural images (Lee,
/// Mumford and Huang 2001). `contrast` 0..1 scales grey about its middle. O(texels).
Texture dead_leaves(double width, double height, double contrast, std::uint64_t seed);

/// Grey at (u, v) [m] blended from the two levels whose texels are nearest to `footprint` [m].
float sample(const Texture& texture, float u, float v, float footprint);

}  // namespace loopbench
