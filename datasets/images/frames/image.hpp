/// Image container independent of image libraries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace loopbench::rgbd {

/// Pixels in row-major order without padding.
template <class Pixel>
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Pixel> pixels = {};

  Image() = default;
  Image(int columns, int rows, Pixel value = {})
      : width(columns),
        height(rows),
        pixels(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), value) {}

  Pixel& at(int x, int y) { return pixels[index(x, y)]; }
  const Pixel& at(int x, int y) const { return pixels[index(x, y)]; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

using GreyImage = Image<std::uint8_t>;
using DepthImage = Image<float>;  ///< depth along the optical axis [m]; 0: not measured

struct RgbdFrame {
  GreyImage grey;
  DepthImage depth;
};

}  // namespace loopbench::rgbd
