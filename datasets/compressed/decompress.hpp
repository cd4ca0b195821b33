/// Decompression of files and of the chunks of bags.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace loopbench {

enum class Codec { gzip, bzip2, zstd, lz4, xz, deflate };

/// Damaged or truncated compressed data.
class DamagedStream : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Compressed data that expand to more bytes than permitted.
class ExpandsTooFar final : public DamagedStream {
 public:
  using DamagedStream::DamagedStream;
};

/// The codec whose magic bytes the data start with; nothing for other data. deflate has none.
std::optional<Codec> codec_of(std::string_view bytes);

/// Passes the content of all concatenated frames of `bytes` to `sink`, at most 256 KiB at a time.
/// Throws DamagedStream with the reason if they are damaged or end early, ExpandsTooFar if they
/// expand to more than `limit` bytes, MissingPart if the build lacks the libraries. O(result).
void decompress(Codec codec,
                std::string_view bytes,
                std::size_t limit,
                const std::function<void(std::string_view)>& sink);

/// The same, into a string.
std::string decompress(Codec codec, std::string_view bytes, std::size_t limit);

}  // namespace loopbench
