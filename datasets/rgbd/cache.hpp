/// File cache of intermediate results, with atomic writes and seals.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace loopbench::rgbd {

/// A cache entry: its file is `folder / name`. The seal of the stored bytes covers the name and the
/// build, so that an entry that was moved, exchanged or written by other code is not read.
struct CacheEntry {
  std::filesystem::path folder;
  std::string name;   ///< contains the key, see cache_name()
  std::string build;  ///< identifies the code that computes the content

  std::filesystem::path file() const { return folder / name; }
};

/// Returns the bytes stored for `entry`, or nothing if they are missing, not in a regular file,
/// truncated, corrupt, or sealed for another name or build.
std::optional<std::string> load_cached(const CacheEntry& entry);

/// Replaces the file of `entry` with replace_file(), so that an interrupted run leaves no partial
/// file and links are not followed. Write errors (full or read-only disk) are ignored.
void store_cached(const CacheEntry& entry, const std::string& bytes);

/// Exclusive lock for work on `entry` between processes of one machine; blocks until it is
/// acquired. If locking fails, work may be done twice with bit-identical results.
class CacheLock {
 public:
  explicit CacheLock(const CacheEntry& entry);
  ~CacheLock();
  CacheLock(const CacheLock&) = delete;
  CacheLock& operator=(const CacheLock&) = delete;

 private:
  int handle_;
};

/// "STAGE-KEY", with KEY in hexadecimal.
std::string cache_name(const std::string& stage, std::uint64_t key);

}  // namespace loopbench::rgbd
