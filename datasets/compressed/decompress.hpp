/// Decompression of files and of the chunks of bags.
#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace loopbench {

enum class Codec { gzip, bzip2, zstd, lz4 };

/// Damaged or truncated compressed data.
class DamagedStream final : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The codec whose magic bytes the data start with; nothing for other data.
std::optional<Codec> codec_of(std::string_view bytes);

/// Decompresses all concatenated frames of `bytes`. Throws DamagedStream with the reason if they
/// are damaged, end early or expand to more than `limit` bytes; MissingPart if the build lacks the
/// library. O(result).
std::string decompress(Codec codec, std::string_view bytes, std::size_t limit);

/// The same, up to the first damage or the end of truncated data. Libraries decode block by block,
/// so that the rest of a damaged block is missing, too.
std::string decompress_intact(Codec codec, std::string_view bytes, std::size_t limit);

}  // namespace loopbench
