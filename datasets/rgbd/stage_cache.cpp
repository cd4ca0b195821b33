#include "datasets/rgbd/stage_cache.hpp"

#include <fmt/format.h>

#include "datasets/hash.hpp"

namespace loopbench::rgbd {

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
  refined_ = cache_name("refined", mixed(loops, to_text(echo(options.refine))));
}

CacheEntry StageCache::frame(std::size_t index) const {
  return entry(fmt::format("{}/{:06}", frames_, index));
}

}  // namespace loopbench::rgbd
