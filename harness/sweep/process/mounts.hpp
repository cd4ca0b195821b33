/// Names of files at other mount points.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace loopbench::harness {

struct Mount {
  std::string device;          ///< major:minor
  std::filesystem::path root;  ///< of the mounted part, in its file system
  std::filesystem::path point;
};

/// Those in the text of /proc/self/mountinfo, in its order.
std::vector<Mount> mounts_in(const std::string& mountinfo);

/// The names that an absolute path also has where its file system, or a part of it, is mounted a
/// second time (`mount --bind`). O(mounts).
std::vector<std::filesystem::path> other_names(const std::filesystem::path& path,
                                               const std::vector<Mount>& mounts);

}  // namespace loopbench::harness
