#include "datasets/rgbd/tracking/keyframe_rule.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace loopbench::rgbd {
namespace {

constexpr double kMinTrackedShare = 0.2;  // of the points of the last keyframe [-]
constexpr double kMinCommonPoints = 60.0;
constexpr double kMaxParallax = 0.15;  // distance over median depth [-]
constexpr double kMaxAngle = 15.0;     // [deg]
constexpr double kMaxTime = 2.0;       // [s]

}  // namespace

double novelty(const FrameRelation& view) {
  const double common = static_cast<double>(view.common);
  const double share = view.points == 0 ? 0.0 : common / static_cast<double>(view.points);
  return std::max({(1.0 - share) / (1.0 - kMinTrackedShare),
                   kMinCommonPoints / std::max(common, 1.0),
                   view.distance / std::max(view.depth, 0.1) / kMaxParallax,
                   view.angle * 180.0 / std::numbers::pi / kMaxAngle,
                   view.time / kMaxTime});
}

double novelty_due(std::int64_t target,
                   std::size_t selected,
                   std::size_t frame,
                   std::size_t frames) {
  if (target == 0 || frames < 2) return 1.0;
  constexpr double kFactor = 2.0;
  const double share = static_cast<double>(frame) / static_cast<double>(frames - 1);
  const double planned = 1.0 + share * static_cast<double>(target - 1);
  return std::pow(kFactor, static_cast<double>(selected) - planned);
}

}  // namespace loopbench::rgbd
