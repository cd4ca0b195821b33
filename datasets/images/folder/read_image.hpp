/// Reading of PNG and JPEG images.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "datasets/images/frames/image.hpp"

namespace loopbench::rgbd {

/// Limits, checked before anything is allocated. The largest decoded image needs 0.5 GB.
inline constexpr std::size_t kLargestImageFile = std::size_t{256} << 20;  ///< [bytes]
inline constexpr std::int64_t kMostPixels = std::int64_t{1} << 26;        ///< 8192 x 8192

/// Reads an image and converts colour to grey (0.30 R + 0.59 G + 0.11 B). Throws InputError if the
/// file is missing, not a regular file, truncated, not a PNG or JPEG, or beyond a limit.
GreyImage read_grey(const std::filesystem::path& file);

/// Reads a 16-bit PNG. Throws InputError as read_grey() does, and for 8 bits per pixel.
Image<std::uint16_t> read_depth(const std::filesystem::path& file);

}  // namespace loopbench::rgbd
