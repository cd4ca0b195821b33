/// Steps 2 to 4: segments of nodes with similar speed and without sharp turns.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "methods/smoothers/manifold/kappa.hpp"

namespace loopbench::methods::manifold {

/// Criterion for an edge to belong to a segment, with `band` in m/s. range: all speeds of the
/// segment lie within `band`. adjacent: at most `band` from the previous edge. bins: in the same of
/// the bins 0..band..2 band... running_mean: at most `band` from the mean of the segment so far.
/// absolute: on the same side of `band` as the previous edge.
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
  double turn_max = 0.75;  ///< maximum kappa at an inner node [rad, or unit of kappa]
  SpeedRule speed = SpeedRule::range;
  Kappa kappa = Kappa::turn_per_kf;
  CurveSpace plane = CurveSpace::space;
  std::optional<double> torsion_max = std::nullopt;  ///< maximum torsion at an inner node [rad]
};

/// Torsion per keyframe at every node: the angle between the planes through the three nodes that
/// end there and the three around it (article, equation 5, with t as index) [rad]; 0 at the first
/// two and the last node and where three nodes lie on a line. O(n).
std::vector<double> torsions(const Nodes& nodes);

/// Splits at least two nodes into consecutive segments. A segment grows while its speeds satisfy
/// the rule; a kappa or a torsion above its threshold closes it and starts the next segment at that
/// node with new speed statistics. Source: article section 3.3; design readings 5.2 and 5.3. O(n).
std::vector<NodeRange> segments(const Nodes& nodes,
                                const SegmentRule& rule,
                                std::span<const double> kappa);

/// The same with kappa = turn_per_kf in space, regardless of the rule.
std::vector<NodeRange> segments(const Nodes& nodes, const SegmentRule& rule);

}  // namespace loopbench::methods::manifold
