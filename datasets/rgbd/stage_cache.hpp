/// Cache of the results of front-end stages.
#pragma once

#include <functional>
#include <string>

#include "datasets/rgbd/cache.hpp"
#include "datasets/rgbd/frontend.hpp"

namespace loopbench::rgbd {

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

  /// Returns unpack(content of `file`) if it is valid; otherwise calls make() and stores its
  /// result.
  template <class Unpack, class Make, class Pack>
  auto get(const CacheEntry& file, Unpack unpack, Make make, Pack pack) const {
    if (folder_.empty()) return make();
    if (const std::optional<std::string> bytes = load_cached(file)) {
      try {
        return unpack(*bytes);
      } catch (const std::runtime_error&) {  // invalid content: recompute
      }
    }
    auto out = make();
    store_cached(file, pack(out));
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
