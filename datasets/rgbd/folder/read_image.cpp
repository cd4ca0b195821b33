#include "datasets/rgbd/folder/read_image.hpp"

#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "datasets/core/error.hpp"

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

using Bytes = std::basic_string<char>;

Bytes contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw input_error(file.string(), 0, "no such image");
  Bytes out((std::istreambuf_iterator<char>(in)), {});
  if (out.empty()) throw input_error(file.string(), 0, "is empty, expected a PNG or JPEG");
  return out;
}

/// Whether a JPEG lacks the end marker FF D9; the decoder fills missing pixels without an error.
bool is_truncated_jpeg(const Bytes& bytes) {
  const bool jpeg = bytes.size() > 2 && bytes[0] == '\xff' && bytes[1] == '\xd8';
  return jpeg && bytes.find("\xff\xd9", bytes.size() - std::min<std::size_t>(64, bytes.size())) ==
                     Bytes::npos;
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
  Image<Pixel> out;
  int channels = 0;
  const std::unique_ptr<Pixel, Free<Pixel>> pixels(
      decode(reinterpret_cast<const stbi_uc*>(bytes.data()),
             static_cast<int>(bytes.size()),
             &out.width,
             &out.height,
             &channels,
             1));
  if (!pixels) {
    throw input_error(
        file.string(), 0, std::string("is not a valid PNG or JPEG: ") + stbi_failure_reason());
  }
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
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  if (!stbi_is_16_bit_from_memory(data, static_cast<int>(bytes.size()))) {
    throw input_error(file.string(), 0, "has not 16 bits per pixel, expected a 16-bit PNG");
  }
  return decoded<stbi_us>(file, bytes, stbi_load_16_from_memory);
}

}  // namespace loopbench::rgbd
