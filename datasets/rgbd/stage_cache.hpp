/// Cache of the results of front-end stages.
#pragma once

#include <functional>
#include <string>

#include "datasets/rgbd/cache.hpp"
#include "datasets/rgbd/frontend.hpp"

namespace loopbench::rgbd {

/// The key of a stage depends on the images and on the options of this and all previous stages:
/// features, tracking, loops, refinement by depth. An empty folder disables the cache.
class StageCache {
 public:
  StageCache(const std::filesystem::path& folder,
             const RgbdSource& source,
             const FrontendOptions& options);

  std::filesystem::path frame(std::size_t index) const;
  const std::filesystem::path& tracked() const { return tracked_; }
  const std::filesystem::path& loops() const { return loops_; }
  const std::filesystem::path& refined() const { return refined_; }

  /// Returns unpack(content of `file`) if it is valid; otherwise calls make() and stores its
  /// result.
  template <class Unpack, class Make, class Pack>
  auto get(const std::filesystem::path& file, Unpack unpack, Make make, Pack pack) const {
    if (folder_.empty()) return make();
    if (const std::optional<std::string> bytes = load_cached(file)) {
      try {
        return unpack(*bytes);
      } catch (const std::runtime_error&) {  // layout of another build: recompute
      }
    }
    auto out = make();
    store_cached(file, pack(out));
    return out;
  }

 private:
  std::filesystem::path folder_;
  std::filesystem::path frames_;
  std::filesystem::path tracked_;
  std::filesystem::path loops_;
  std::filesystem::path refined_;
};

}  // namespace loopbench::rgbd
