/// Reading of PNG and JPEG images.
#pragma once

#include <cstdint>
#include <filesystem>

#include "datasets/rgbd/image.hpp"

namespace loopbench::rgbd {

/// Reads an image and converts colour to grey (0.30 R + 0.59 G + 0.11 B). Throws InputError if the
/// file is missing, truncated or not a PNG or JPEG.
GreyImage read_grey(const std::filesystem::path& file);

/// Reads a 16-bit PNG. Throws InputError if the file is missing, truncated or has 8 bits per pixel.
Image<std::uint16_t> read_depth(const std::filesystem::path& file);

}  // namespace loopbench::rgbd
