/// Relative pose error: how far motions over a given stretch differ from the reference's.
#pragma once

#include <optional>

#include "metrics/errors/relation.hpp"
#include "metrics/metric.hpp"
#include "metrics/pairing/pairs/stretch.hpp"

namespace loopbench {

/// What the numbers of single axes are components of.
enum class RpeFrame {
  body,   ///< the translation of E, in the body at j: their squares add up to the 3-D ones
  world,  ///< the change of the position error, e_j - e_i, in the reference's world
};
inline auto choices(RpeFrame) {
  return std::array{std::pair{"body", RpeFrame::body}, std::pair{"world", RpeFrame::world}};
}

/// A rule of the protocol, or another one for this metric.
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
  visit("delta", o.delta, "length of the stretch [unit]", Above{0.0});
  visit("unit", o.unit, "frames (pairs in a row), seconds, metres of path, or turning");
  visit("tolerance", o.tolerance, "miss as part of delta [-]; none: the protocol's", Between{0.0});
  visit("min_pairs",
        o.min_pairs,
        "fewest pairs that give a number; none: the protocol's",
        Between{1.0});
  visit(
      "frame",
      o.frame,
      "axes and rpy: components of the error transform, whose squares add up to 3d (body), or the "
      "change of the position error (world)");
  visit("pairs_from", o.pairs_from, "whose path and turning measure metres and angles");
  visit("pairs", o.pairs, "which pairs are taken");
  visit("relation", o.relation, "what is measured");
}

/// Throws OptionError when delta and unit do not fit.
void check_combination(const RpeOptions& options);

/// Throws OptionError for pairs `tum` where the protocol does not pair whole files.
void check_protocol(const RpeOptions& options, const Protocol& protocol);

/// Of E, in the protocol's form, over the pairs of its rule. Relation `usual`: translation 3d [m]
/// |trans(E)|, rotation 3d [deg] angle(E), translation x, y, z [m] magnitudes in `frame`. `rpy`:
/// rotation roll, pitch, yaw [deg] of E, turned into the world for frame world (as rpg's). The
/// others one score of that name; point_distance is ||q_j - q_i| - |p_j - p_i||, its ratio leaves
/// out pairs where the reference stands still. For positions without attitude
/// (position_only.hpp) only world axes and point distances are defined. Pairs from the reference
/// are the same for every method. `count` of every score is the number of its pairs. Pairs
/// `tum_random` have no delta: Undefined when one is given. Throws OptionError when delta and unit
/// do not fit, and for pairs `tum` where the protocol has another rule, std::runtime_error when
/// fewer than min_pairs pairs are that far apart, Undefined when that is the reference's doing.
/// O(n log n), but see angle_pairs.hpp.
std::vector<Score> rpe(const Evaluation& evaluation, const RpeOptions& options);

}  // namespace loopbench
