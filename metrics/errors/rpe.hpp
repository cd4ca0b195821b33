/// Relative pose error: difference of relative motions between estimate and reference.
#pragma once

#include <optional>

#include "metrics/errors/relation.hpp"
#include "metrics/metric.hpp"
#include "metrics/pairing/select_pairs.hpp"

namespace loopbench::metrics {

/// Frame of the single-axis scores.
enum class RpeFrame {
  body,   ///< translation of E, in the body frame at j; the squares add up to the squared 3-D error
  world,  ///< change of the position error, e_j - e_i, in the reference's world frame
};
inline auto choices(RpeFrame) {
  return std::array{std::pair{"body", RpeFrame::body}, std::pair{"world", RpeFrame::world}};
}

/// Pair rule of the protocol, or another rule for this metric.
enum class RpePairs { protocol, all, consecutive, tum };
inline auto choices(RpePairs) {
  return std::array{std::pair{"protocol", RpePairs::protocol},
                    std::pair{"all", RpePairs::all},
                    std::pair{"consecutive", RpePairs::consecutive},
                    std::pair{"tum", RpePairs::tum}};
}
enum class RpePairsFrom { protocol, reference, estimate };
inline auto choices(RpePairsFrom) {
  return std::array{std::pair{"protocol", RpePairsFrom::protocol},
                    std::pair{"reference", RpePairsFrom::reference},
                    std::pair{"estimate", RpePairsFrom::estimate}};
}

struct RpeOptions {
  double delta = 1.0;
  DeltaUnit unit = DeltaUnit::frames;
  std::optional<double> tolerance{};
  std::optional<double> min_pairs{};
  RpeFrame frame = RpeFrame::body;
  RpePairsFrom pairs_from = RpePairsFrom::protocol;
  RpePairs pairs = RpePairs::protocol;
  Relation relation = Relation::usual;
};

template <class Visit>
void fields(RpeOptions& o, Visit visit) {
  visit("delta", o.delta, "distance between paired poses, in the unit of `unit`", GreaterThan{0.0});
  visit("unit",
        o.unit,
        "unit of delta: frames, seconds, metres of path, or degrees or radians of rotation");
  visit("tolerance",
        o.tolerance,
        "tolerance relative to delta [-]; default: the protocol's",
        Between{0.0});
  visit("min_pairs", o.min_pairs, "minimum number of pairs; default: the protocol's", Between{1.0});
  visit("frame",
        o.frame,
        "frame of single-axis and rpy scores: body (components of the error transform, whose "
        "squares add up to 3d) or world (change of the position error)");
  visit("pairs_from",
        o.pairs_from,
        "trajectory that defines path length and rotation angle of a pair");
  visit("pairs", o.pairs, "rule that selects the pose pairs");
  visit("relation", o.relation, "pose relation");
}

/// Throws OptionError if delta and unit contradict each other.
void check_combination(const RpeOptions& options);

/// Throws OptionError for pairs `tum` if the protocol does not use complete files.
void check_protocol(const RpeOptions& options, const Protocol& protocol);

/// Scores of E, in the protocol's form, over the pairs of its rule. Relation `usual`: translation
/// 3d [m] |trans(E)|, rotation 3d [deg] angle(E), translation x, y, z [m] magnitudes in `frame`.
/// `rpy`: rotation roll, pitch, yaw [deg] of E, rotated into the world for frame world (as rpg).
/// The other relations give one score of that name; point_distance is ||q_j - q_i| - |p_j - p_i||,
/// and its ratio skips pairs where the reference does not move. For trajectories that hold only
/// positions (position_only.hpp) only world axes and point distances are defined. Pairs selected on
/// the reference are identical for every method. `count` of every score is the number of its pairs.
/// Pairs `tum_random` have no delta: Undefined if one is given. Throws OptionError if delta and
/// unit contradict each other, and for pairs `tum` if the protocol has another rule;
/// std::runtime_error if fewer than min_pairs pairs are found, Undefined if the reference is the
/// cause. O(n log n), but see angle_pairs.hpp.
std::vector<Score> rpe(const Evaluation& evaluation, const RpeOptions& options);

}  // namespace loopbench::metrics
