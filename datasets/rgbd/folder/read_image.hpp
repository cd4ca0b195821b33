/// Image files of the kinds RGB-D recordings come in: PNG and JPEG.
#pragma once

#include <cstdint>
#include <filesystem>

#include "datasets/rgbd/image.hpp"

namespace loopbench {

/// Colour is weighed to grey (0.30 R + 0.59 G + 0.11 B). Throws InputError: missing, truncated, no
/// PNG or JPEG.
GreyImage read_grey(const std::filesystem::path& file);

/// A PNG of 16 bits. Throws InputError: missing, truncated, of 8 bits.
Image<std::uint16_t> read_depth(const std::filesystem::path& file);

}  // namespace loopbench
