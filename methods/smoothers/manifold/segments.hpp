/// Steps 2 to 4: segments of nodes with similar speed and without sharp turns, and the treatment of
/// segments with fewer nodes than a window.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "datasets/core/problem.hpp"
#include "methods/smoothers/manifold/families/nodes.hpp"
#include "methods/smoothers/manifold/spline.hpp"

namespace loopbench::methods::manifold {

/// turn_per_kf: angle between consecutive steps [rad]; the only one whose printed thresholds
/// segment both sequences usefully. menger: 1 / radius of the circle through three nodes [1/m].
/// dtheta_ds, dtheta_dt: the angle over the mean step [1/m] or the mean duration [rad/s].
/// analytic_spline: curvature of the cubic spline [1/m]. rotation_per_kf: half the camera rotation
/// over both steps [rad].
enum class Kappa { turn_per_kf, menger, dtheta_ds, dtheta_dt, analytic_spline, rotation_per_kf };
inline auto choices(Kappa) {
  return std::array{std::pair{"turn_per_kf", Kappa::turn_per_kf},
                    std::pair{"menger", Kappa::menger},
                    std::pair{"dtheta_ds", Kappa::dtheta_ds},
                    std::pair{"dtheta_dt", Kappa::dtheta_dt},
                    std::pair{"analytic_spline", Kappa::analytic_spline},
                    std::pair{"rotation_per_kf", Kappa::rotation_per_kf}};
}

/// space: the path in space. plane: the path projected along the up axis, the article's xoy plane.
enum class CurveSpace { space, plane };
inline auto choices(CurveSpace) {
  return std::array{std::pair{"3d", CurveSpace::space}, std::pair{"xy", CurveSpace::plane}};
}

/// Returns kappa at every node, 0 at the first and last. `poses` are the nodes with their rotation,
/// used by rotation_per_kf only, which ignores `plane`. O(n).
std::vector<double> kappas(const Nodes& nodes,
                           const Trajectory& poses,
                           Kappa definition,
                           CurveSpace plane,
                           const Vector3& up);

/// borrow_neighbours: their windows include nodes of the neighbouring segments. merge: they are
/// merged with the neighbour of the most similar mean speed. polyline: straight lines.
/// quasi_keyframes: tracked frames are inserted; without such frames nodes are borrowed.
enum class ShortPolicy { borrow_neighbours, merge, polyline, quasi_keyframes };
inline auto choices(ShortPolicy) {
  return std::array{std::pair{"borrow_neighbours", ShortPolicy::borrow_neighbours},
                    std::pair{"merge", ShortPolicy::merge},
                    std::pair{"polyline", ShortPolicy::polyline},
                    std::pair{"quasi_keyframes", ShortPolicy::quasi_keyframes}};
}

/// Merges segments with fewer than `min_nodes` nodes, left to right, with the neighbour of the most
/// similar mean speed, regardless of the segmentation rules. O(n).
std::vector<NodeRange> merge_short_segments(const Nodes& nodes,
                                            std::vector<NodeRange> runs,
                                            std::size_t min_nodes);

/// Nodes and segments after the insertion of tracked frames.
struct FilledSegments {
  Trajectory nodes;
  std::vector<NodeRange> runs;
  std::size_t inserted = 0;
};

/// Divides every edge of a segment with fewer than `min_nodes` nodes into as many equal parts as
/// are needed to reach `min_nodes`, and inserts the tracked frame nearest to each division. O(n log
/// frames).
FilledSegments fill_short_segments(const Trajectory& nodes,
                                   const std::vector<NodeRange>& runs,
                                   const Trajectory& frames,
                                   std::size_t min_nodes);

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
/// node with new speed statistics. Source: article section 3.3. O(n).
std::vector<NodeRange> segments(const Nodes& nodes,
                                const SegmentRule& rule,
                                std::span<const double> kappa);

/// The same with kappa = turn_per_kf in space, regardless of the rule.
std::vector<NodeRange> segments(const Nodes& nodes, const SegmentRule& rule);

}  // namespace loopbench::methods::manifold
