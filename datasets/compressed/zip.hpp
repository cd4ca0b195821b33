/// Reading of zip archives.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace loopbench {

struct ZipMember {
  std::string name;
  std::string content;
};

bool is_zip(std::string_view bytes);

/// The files of an archive, without folders and the metadata of macOS. Throws DamagedStream if it
/// is damaged, encrypted, larger than 4 GiB (ZIP64) or uses another compression than deflate, and
/// ExpandsTooFar if all files have more than `limit` bytes. O(result).
std::vector<ZipMember> zip_members(std::string_view bytes, std::size_t limit);

}  // namespace loopbench
