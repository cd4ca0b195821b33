/// Reading of zip archives.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/compressed/crc32.hpp"
#include "datasets/compressed/decompress.hpp"

namespace loopbench {

struct ZipMember {
  std::string name;
  std::string content;
};

inline constexpr std::string_view kLocalMark = "PK\3\4";
inline constexpr std::string_view kEntryMark = "PK\1\2";
inline constexpr std::string_view kEndMark = "PK\5\6";
inline constexpr std::size_t kLocalSize = 30, kEntrySize = 46,
                             kEndSize = 22;  // fixed parts [bytes]

template <class T>
inline T at(std::string_view bytes, std::size_t place) {
  static_assert(std::endian::native == std::endian::little);
  T out{};
  if (bytes.size() < sizeof(T) || place > bytes.size() - sizeof(T)) {
    throw DamagedStream("ends early");
  }
  std::memcpy(&out, bytes.data() + place, sizeof(T));
  return out;
}

inline std::string_view part(std::string_view bytes, std::size_t place, std::size_t size) {
  if (place > bytes.size() || size > bytes.size() - place) throw DamagedStream("ends early");
  return bytes.substr(place, size);
}

inline std::string content_of_entry(std::string_view bytes,
                                    std::string_view entry,
                                    std::size_t limit) {
  constexpr std::uint16_t kEncrypted = 1, kStored = 0, kDeflated = 8;
  if ((at<std::uint16_t>(entry, 8) & kEncrypted) != 0) throw DamagedStream("is encrypted");
  const auto method = at<std::uint16_t>(entry, 10);
  const std::size_t stored_size = at<std::uint32_t>(entry, 20);
  const std::size_t size = at<std::uint32_t>(entry, 24);
  const std::size_t local = at<std::uint32_t>(entry, 42);
  if (part(bytes, local, kLocalSize).substr(0, 4) != kLocalMark) {
    throw DamagedStream("has no file where its directory states one");
  }
  const std::size_t start = local + kLocalSize + at<std::uint16_t>(bytes, local + 26) +
                            at<std::uint16_t>(bytes, local + 28);
  const std::string_view stored = part(bytes, start, stored_size);
  if (size > limit) throw ExpandsTooFar("expands to more than " + std::to_string(limit) + " bytes");
  std::string out;
  if (method == kStored) {
    out = stored;
  } else if (method == kDeflated) {
    out = decompress(Codec::deflate, stored, size);
  } else {
    throw DamagedStream("has files in compression " + std::to_string(method) +
                        ", expected stored or deflated ones");
  }
  if (out.size() != size || crc32_of(out) != at<std::uint32_t>(entry, 16)) {
    throw DamagedStream("has a file with a wrong checksum");
  }
  return out;
}

inline bool is_zip(std::string_view bytes) { return bytes.starts_with(kLocalMark); }

/// The files of an archive, without folders and the metadata of macOS. Throws DamagedStream if it
/// is damaged, encrypted, larger than 4 GiB (ZIP64) or uses another compression than deflate, and
/// ExpandsTooFar if all files have more than `limit` bytes. O(result).
inline std::vector<ZipMember> zip_members(std::string_view bytes, std::size_t limit) {
  const std::size_t end = bytes.rfind(kEndMark);
  if (end == bytes.npos) throw DamagedStream("has no directory at its end");
  part(bytes, end, kEndSize);
  const auto count = at<std::uint16_t>(bytes, end + 10);
  std::size_t place = at<std::uint32_t>(bytes, end + 16);
  std::vector<ZipMember> out;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string_view entry = part(bytes, place, kEntrySize);
    if (!entry.starts_with(kEntryMark)) throw DamagedStream("has a damaged directory");
    const auto name_size = at<std::uint16_t>(entry, 28);
    const std::string name(part(bytes, place + kEntrySize, name_size));
    place += kEntrySize + name_size + at<std::uint16_t>(entry, 30) + at<std::uint16_t>(entry, 32);
    if (name.ends_with('/') || name.starts_with("__MACOSX/")) continue;
    out.push_back({name, content_of_entry(bytes, entry, limit)});
    limit -= out.back().content.size();
  }
  return out;
}

}  // namespace loopbench
