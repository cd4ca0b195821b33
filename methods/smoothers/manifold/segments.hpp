/// Steps 2 to 4: runs of nodes of similar speed without a sharp turn.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "methods/smoothers/manifold/kappa.hpp"

namespace loopbench::manifold {

/// When an edge belongs to a segment, `band` in m/s. range: all speeds within `band`. adjacent: no
/// more than `band` from the edge before. bins: in the same of the bins 0..band..2 band...
/// running_mean: no more than `band` from the mean of the segment so far. absolute: on the same
/// side of `band`.
enum class SpeedRule { range, adjacent, bins, running_mean, absolute };
inline auto choices(SpeedRule) {
  return std::array{std::pair{"range", SpeedRule::range},
                    std::pair{"adjacent", SpeedRule::adjacent},
                    std::pair{"bins", SpeedRule::bins},
                    std::pair{"running_mean", SpeedRule::running_mean},
                    std::pair{"absolute", SpeedRule::absolute}};
}

struct SegmentRule {
  std::optional<double> speed_band = std::nullopt;  ///< [m/s]; none: the mean speed
  double turn_max = 0.75;  ///< most kappa at an inner node [rad, or as kappa has it]
  SpeedRule speed = SpeedRule::range;
  Kappa kappa = Kappa::turn_per_kf;
  Plane plane = Plane::space;
};

/// Covers all nodes (two at least), left to right. A segment grows while its speeds obey the rule;
/// a kappa above the threshold closes it and that node opens the next one, which forgets the
/// speeds so far. Source: paper section 3.3; design readings 5.2 and 5.3. O(n).
std::vector<NodeRange> segments(const Nodes& nodes,
                                const SegmentRule& rule,
                                std::span<const double> kappa);

/// With kappa the turn per keyframe in space, whatever the rule says.
std::vector<NodeRange> segments(const Nodes& nodes, const SegmentRule& rule);

}  // namespace loopbench::manifold
