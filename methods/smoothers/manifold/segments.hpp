/// Steps 1 to 4: tracked frames as additional nodes where keyframes are too far apart, segments of
/// nodes with similar speed and without sharp turns, and the treatment of segments with fewer nodes
/// than a window.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "datasets/core/problem.hpp"
#include "methods/smoothers/manifold/families/nodes.hpp"

namespace loopbench::methods::manifold {

struct GapRule {
  std::optional<double> time_max = 1.0;       ///< maximum gap without insertion [s]; none: no limit
  std::optional<double> rotation_max = 1.09;  ///< maximum rotation without insertion [rad]
  std::optional<double> common_min = 1.0;     ///< minimum common landmarks without insertion
};

struct NodesWithQuasiKeyframes {
  Trajectory nodes;           ///< keyframes and the quasi-keyframes between them
  std::size_t inserted = 0;   ///< number of quasi-keyframes
  std::size_t gaps_left = 0;  ///< gaps above the limits without any tracked frame
};

/// Divides each gap above the limits into equal parts within the limits and inserts the tracked
/// frame nearest to each division; poses are never interpolated. Gaps between keyframes with too
/// few common landmarks (problem.shared_landmarks, if known) are divided into at least two parts.
/// Source: article section 3.3, where frames are chosen manually. O(keyframes log frames).
NodesWithQuasiKeyframes with_quasi_keyframes(const Problem& problem, const GapRule& rule);

/// turn_per_kf: angle between consecutive steps [rad]; the only one whose printed thresholds
/// segment both sequences usefully. menger: 1 / radius of the circle through three nodes [1/m].
/// dtheta_dt: the angle over the mean duration [rad/s].
enum class Kappa { turn_per_kf, menger, dtheta_dt };
inline auto choices(Kappa) {
  return std::array{std::pair{"turn_per_kf", Kappa::turn_per_kf},
                    std::pair{"menger", Kappa::menger},
                    std::pair{"dtheta_dt", Kappa::dtheta_dt}};
}

/// space: the path in space. plane: the path projected along the up axis, the article's xoy plane.
enum class CurveSpace { space, plane };
inline auto choices(CurveSpace) {
  return std::array{std::pair{"3d", CurveSpace::space}, std::pair{"xy", CurveSpace::plane}};
}

/// Returns kappa at every node, 0 at the first and last. O(n).
std::vector<double> kappas(const Nodes& nodes,
                           Kappa definition,
                           CurveSpace plane,
                           const Vector3& up);

/// borrow_neighbours: their windows include nodes of the neighbouring segments. polyline: straight
/// lines.
enum class ShortPolicy { borrow_neighbours, polyline };
inline auto choices(ShortPolicy) {
  return std::array{std::pair{"borrow_neighbours", ShortPolicy::borrow_neighbours},
                    std::pair{"polyline", ShortPolicy::polyline}};
}

/// Criterion for an edge to belong to a segment, with `band` in m/s. range: all speeds of the
/// segment lie within `band`. adjacent: at most `band` from the previous edge.
enum class SpeedRule { range, adjacent };
inline auto choices(SpeedRule) {
  return std::array{std::pair{"range", SpeedRule::range},
                    std::pair{"adjacent", SpeedRule::adjacent}};
}

struct SegmentRule {
  std::optional<double> speed_band = std::nullopt;  ///< [m/s]; none: the mean speed
  double turn_max = 0.75;  ///< maximum kappa at an inner node [rad, or unit of kappa]
  SpeedRule speed = SpeedRule::range;
  Kappa kappa = Kappa::turn_per_kf;
  CurveSpace plane = CurveSpace::space;
};

/// Splits at least two nodes into consecutive segments. A segment grows while its speeds satisfy
/// the rule; a kappa above its threshold closes it and starts the next segment at that node with
/// new speed statistics. Source: article section 3.3. O(n).
std::vector<NodeRange> segments(const Nodes& nodes,
                                const SegmentRule& rule,
                                std::span<const double> kappa);

/// The same with kappa = turn_per_kf in space, regardless of the rule.
std::vector<NodeRange> segments(const Nodes& nodes, const SegmentRule& rule);

}  // namespace loopbench::methods::manifold
