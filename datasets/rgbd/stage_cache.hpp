/// Cache of the results of front-end stages in files, with atomic writes and seals.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "datasets/rgbd/frontend.hpp"

namespace loopbench::rgbd {

/// Features of a frame, or the reason why it could not be read.
struct FrameFeatures {
  std::optional<Features> features = std::nullopt;
  std::string why = {};
};

/// For FrameFeatures, TrackingResult, DetectedLoops and RefinedEdges. deserialised() throws
/// std::runtime_error for bytes in another layout.
template <class T>
std::string serialised(const T& value);
template <class T>
T deserialised(const std::string& bytes);

/// A cache entry: its file is `folder / name`. The seal of the stored bytes covers the name and the
/// build, so that an entry that was moved, exchanged or written by other code is not read.
struct CacheEntry {
  std::filesystem::path folder;
  std::string name;   ///< "STAGE-KEY"
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

/// The key of a stage depends on the images and on the options of this and all previous stages:
/// features, tracking, loops, refinement by depth. Entries of another build are recomputed. An
/// empty folder disables the cache.
class StageCache {
 public:
  StageCache(const FrontendHooks& hooks, const RgbdSource& source, const FrontendOptions& options);

  CacheEntry frame(std::size_t index) const;
  CacheEntry tracked() const { return entry(tracked_); }
  CacheEntry loops() const { return entry(loops_); }
  CacheEntry refined() const { return entry(refined_); }

  /// Returns the content of `file` if it is valid; otherwise calls make() and stores its result.
  template <class Make>
  auto get(const CacheEntry& file, Make make) const {
    using Result = decltype(make());
    if (folder_.empty()) return make();
    if (const std::optional<std::string> bytes = load_cached(file)) {
      try {
        return deserialised<Result>(*bytes);
      } catch (const std::runtime_error&) {  // invalid content: recompute
      }
    }
    Result out = make();
    store_cached(file, serialised(out));
    return out;
  }

 private:
  CacheEntry entry(std::string name) const { return {folder_, std::move(name), build_}; }

  std::filesystem::path folder_;
  std::string build_;
  std::string frames_;
  std::string tracked_;
  std::string loops_;
  std::string refined_;
};

}  // namespace loopbench::rgbd
