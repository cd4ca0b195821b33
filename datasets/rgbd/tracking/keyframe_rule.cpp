#include "datasets/rgbd/tracking/keyframe_rule.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace loopbench::rgbd {

double novelty(const FrameRelation& view, const KeyframeOptions& o) {
  const double common = static_cast<double>(view.common);
  const double share = view.points == 0 ? 0.0 : common / static_cast<double>(view.points);
  return std::max({(1.0 - share) / (1.0 - o.tracked_min),
                   static_cast<double>(o.common_min) / std::max(common, 1.0),
                   view.distance / std::max(view.depth, 0.1) / o.parallax_max,
                   view.angle * 180.0 / std::numbers::pi / o.angle_max,
                   view.time / o.time_max});
}

double novelty_due(const KeyframeOptions& o,
                   std::size_t selected,
                   std::size_t frame,
                   std::size_t frames) {
  if (o.target == 0 || frames < 2) return 1.0;
  constexpr double kFactor = 2.0;
  const double share = static_cast<double>(frame) / static_cast<double>(frames - 1);
  const double planned = 1.0 + share * static_cast<double>(o.target - 1);
  return std::pow(kFactor, static_cast<double>(selected) - planned);
}

}  // namespace loopbench::rgbd
