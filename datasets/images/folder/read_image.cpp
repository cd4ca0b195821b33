#include "datasets/images/folder/read_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>

#include "datasets/core/error.hpp"
#include "datasets/files/regular_file.hpp"

namespace loopbench::rgbd {
namespace {

/// Largest block that the decoder may allocate for the current image [bytes]: a few kilobytes of
/// compressed data can expand to gigabytes that the image does not have.
thread_local std::size_t largest_block = 0;

void* allocated(void* before, std::size_t size) {
  return size > largest_block ? nullptr : std::realloc(before, size);
}

}  // namespace
}  // namespace loopbench::rgbd

#define STBI_MALLOC(size) loopbench::rgbd::allocated(nullptr, size)
#define STBI_REALLOC(before, size) loopbench::rgbd::allocated(before, size)
#define STBI_FREE(before) std::free(before)
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace loopbench::rgbd {
namespace {

using Bytes = std::string;

Bytes contents(const std::filesystem::path& file) {
  Bytes out = read_regular_file(file, kLargestImageFile, "image");
  if (out.empty()) throw input_error(file.string(), 0, "is empty, expected a PNG or JPEG");
  return out;
}

/// Whether a JPEG lacks the end marker FF D9; the decoder fills missing pixels without an error.
bool is_truncated_jpeg(const Bytes& bytes) {
  const bool jpeg = bytes.size() > 2 && bytes[0] == '\xff' && bytes[1] == '\xd8';
  return jpeg && bytes.find("\xff\xd9", bytes.size() - std::min<std::size_t>(64, bytes.size())) ==
                     Bytes::npos;
}

const stbi_uc* data_of(const Bytes& bytes) {
  return reinterpret_cast<const stbi_uc*>(bytes.data());
}

InputError invalid_image(const std::filesystem::path& file) {
  return input_error(
      file.string(), 0, std::string("is not a valid PNG or JPEG: ") + stbi_failure_reason());
}

/// Reads the size in the header, rejects too many pixels and limits the decoder's blocks to a few
/// times what the image needs.
void limit_decoder(const std::filesystem::path& file, const Bytes& bytes) {
  constexpr std::size_t kHeaderBlock = std::size_t{1} << 20;
  largest_block = kHeaderBlock;
  int width = 0;
  int height = 0;
  int channels = 0;
  const int size = static_cast<int>(bytes.size());
  if (stbi_info_from_memory(data_of(bytes), size, &width, &height, &channels) == 0) {
    throw invalid_image(file);
  }
  if (std::int64_t{width} * height > kMostPixels) {
    throw input_error(
        file.string(),
        0,
        fmt::format("has {} x {} pixels, expected at most {} in all", width, height, kMostPixels));
  }
  constexpr std::size_t kBytesPerPixel = 16;  // four channels of 16 bits; buffers double
  largest_block += kBytesPerPixel * (static_cast<std::size_t>(width) + 1) *
                   (static_cast<std::size_t>(height) + 1);
}

template <class Pixel>
struct Free {
  void operator()(Pixel* pixels) const { stbi_image_free(pixels); }
};

template <class Pixel>
Image<Pixel> decoded(const std::filesystem::path& file,
                     const Bytes& bytes,
                     Pixel* (*decode)(const stbi_uc*, int, int*, int*, int*, int)) {
  if (is_truncated_jpeg(bytes)) {
    throw input_error(file.string(), 0, "is truncated: has no JPEG end marker");
  }
  limit_decoder(file, bytes);
  Image<Pixel> out;
  int channels = 0;
  const std::unique_ptr<Pixel, Free<Pixel>> pixels(decode(
      data_of(bytes), static_cast<int>(bytes.size()), &out.width, &out.height, &channels, 1));
  if (!pixels) throw invalid_image(file);
  const auto count = static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
  out.pixels.assign(pixels.get(), pixels.get() + count);
  return out;
}

}  // namespace

GreyImage read_grey(const std::filesystem::path& file) {
  return decoded<stbi_uc>(file, contents(file), stbi_load_from_memory);
}

Image<std::uint16_t> read_depth(const std::filesystem::path& file) {
  const Bytes bytes = contents(file);
  limit_decoder(file, bytes);
  if (!stbi_is_16_bit_from_memory(data_of(bytes), static_cast<int>(bytes.size()))) {
    throw input_error(file.string(), 0, "has not 16 bits per pixel, expected a 16-bit PNG");
  }
  return decoded<stbi_us>(file, bytes, stbi_load_16_from_memory);
}

}  // namespace loopbench::rgbd
