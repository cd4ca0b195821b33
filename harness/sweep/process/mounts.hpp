/// Names of files at other mount points.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace loopbench::harness {

/// The names that an absolute path also has where its file system, or a part of it, is mounted a
/// second time (`mount --bind`), from the text of /proc/self/mountinfo. O(mounts).
std::vector<std::filesystem::path> other_names(const std::filesystem::path& path,
                                               const std::string& mounts);

}  // namespace loopbench::harness
