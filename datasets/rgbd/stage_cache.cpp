#include "datasets/rgbd/stage_cache.hpp"

#include <fmt/format.h>

#include "datasets/hash.hpp"

namespace loopbench::rgbd {
namespace {

// Increment with any change of the result of a stage for the same input.
constexpr std::uint64_t kCacheVersion = 2;

}  // namespace

StageCache::StageCache(const std::filesystem::path& folder,
                       const RgbdSource& source,
                       const FrontendOptions& options)
    : folder_(folder) {
  if (folder.empty()) return;
  const std::uint64_t features =
      mixed(mixed(source.content(), kCacheVersion), to_text(echo(options.features)));
  const std::uint64_t track = mixed(features, to_text(echo(options.track)));
  frames_ = cached_path(folder, "features", features);
  tracked_ = cached_path(folder, "track", track);
  const std::uint64_t loops = mixed(track, to_text(echo(options.loops)));
  loops_ = cached_path(folder, "loops", loops);
  refined_ = cached_path(folder, "refined", mixed(loops, to_text(echo(options.refine))));
}

std::filesystem::path StageCache::frame(std::size_t index) const {
  return frames_ / fmt::format("{:06}", index);
}

}  // namespace loopbench::rgbd
