#include "datasets/rgbd/stage_cache.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "datasets/core/error.hpp"
#include "datasets/formats/regular_file.hpp"
#include "datasets/formats/replace_file.hpp"
#include "datasets/hash.hpp"

namespace loopbench::rgbd {
namespace {

// Seed of the seal; change it with the file layout.
constexpr std::uint64_t kSealSeed = 0x6c6f6f7062656e64u;
constexpr std::size_t kSealBytes = sizeof(std::uint64_t);
constexpr std::size_t kLargestEntry = std::size_t{4} << 30;  // [bytes]

std::string seal(const CacheEntry& entry, std::string_view bytes) {
  const std::uint64_t sum = mixed(mixed(mixed(kSealSeed, entry.build), entry.name), bytes);
  std::string out(kSealBytes, '\0');
  std::memcpy(out.data(), &sum, kSealBytes);
  return out;
}

/// "STAGE-KEY", with KEY in hexadecimal.
std::string cache_name(const std::string& stage, std::uint64_t key) {
  return fmt::format("{}-{:016x}", stage, key);
}

}  // namespace

std::optional<std::string> load_cached(const CacheEntry& entry) {
  try {
    std::string all = read_regular_file(entry.file(), kLargestEntry, "file");
    if (all.size() < kSealBytes) return std::nullopt;
    const std::string_view bytes = std::string_view(all).substr(kSealBytes);
    if (all.compare(0, kSealBytes, seal(entry, bytes)) != 0) return std::nullopt;
    return all.substr(kSealBytes);
  } catch (const InputError&) {  // missing or unreadable: recompute
    return std::nullopt;
  }
}

void store_cached(const CacheEntry& entry, const std::string& bytes) {
  std::error_code ignored;
  std::filesystem::create_directories(entry.file().parent_path(), ignored);
  try {
    replace_file(entry.file(), seal(entry, bytes) + bytes, Target::own);
  } catch (const InputError&) {  // a result that is not cached is computed again
  }
}

CacheLock::CacheLock(const CacheEntry& entry) {
  std::error_code ignored;
  std::filesystem::create_directories(entry.file().parent_path(), ignored);
  const std::string file = entry.file().string() + ".lock";
  handle_ = open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
  if (handle_ >= 0) flock(handle_, LOCK_EX);
}

CacheLock::~CacheLock() {
  if (handle_ >= 0) close(handle_);
}

StageCache::StageCache(const FrontendHooks& hooks,
                       const RgbdSource& source,
                       const FrontendOptions& options)
    : folder_(hooks.cache), build_(hooks.build) {
  if (folder_.empty()) return;
  const std::uint64_t features = mixed(source.content(), to_text(echo(options.features)));
  const std::uint64_t track = mixed(features, to_text(echo(options.track)));
  frames_ = cache_name("features", features);
  tracked_ = cache_name("track", track);
  const std::uint64_t loops = mixed(track, to_text(echo(options.loops)));
  loops_ = cache_name("loops", loops);
  refined_ = cache_name("refined", loops);
}

CacheEntry StageCache::frame(std::size_t index) const {
  return entry(fmt::format("{}/{:06}", frames_, index));
}

}  // namespace loopbench::rgbd
