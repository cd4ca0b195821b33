/// File cache of intermediate results, with atomic writes and checksums.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace loopbench::rgbd {

/// Returns the bytes stored in `file`, or nothing if it is missing, truncated or corrupt.
std::optional<std::string> load_cached(const std::filesystem::path& file);

/// Writes to a temporary file and renames it, so that an interrupted run leaves no partial file.
/// Write errors (full or read-only disk) are ignored.
void store_cached(const std::filesystem::path& file, const std::string& bytes);

/// Exclusive lock for work on `file` between processes of one machine; blocks until it is acquired.
/// If locking fails, work may be done twice with bit-identical results.
class CacheLock {
 public:
  explicit CacheLock(const std::filesystem::path& file);
  ~CacheLock();
  CacheLock(const CacheLock&) = delete;
  CacheLock& operator=(const CacheLock&) = delete;

 private:
  int handle_;
};

/// Path `folder / stage-KEY`, with KEY in hexadecimal.
std::filesystem::path cached_path(const std::filesystem::path& folder,
                                  const std::string& stage,
                                  std::uint64_t key);

}  // namespace loopbench::rgbd
