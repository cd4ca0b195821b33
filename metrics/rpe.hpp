/// Relative pose error: how far motions over a given stretch differ from the reference's.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

enum class DeltaUnit { frames, s, m };
inline auto choices(DeltaUnit) {
  return std::array{std::pair{"frames", DeltaUnit::frames},
                    std::pair{"s", DeltaUnit::s},
                    std::pair{"m", DeltaUnit::m}};
}

/// Where the numbers of single axes live.
enum class RpeFrame {
  world,  ///< change of the position error, e_j - e_i, in the reference's world
  body,   ///< translation of E in the body at j
};
inline auto choices(RpeFrame) {
  return std::array{std::pair{"world", RpeFrame::world}, std::pair{"body", RpeFrame::body}};
}

/// Whose path measures metres.
enum class DistanceOf { reference, estimate };
inline auto choices(DistanceOf) {
  return std::array{std::pair{"reference", DistanceOf::reference},
                    std::pair{"estimate", DistanceOf::estimate}};
}

struct RpeOptions {
  double delta = 1.0;
  DeltaUnit unit = DeltaUnit::frames;
  double tolerance = 0.1;
  RpeFrame frame = RpeFrame::world;
  DistanceOf distance_of = DistanceOf::reference;
};

template <class Visit>
void fields(RpeOptions& o, Visit visit) {
  visit("delta", o.delta, "length of the stretch [unit]", Above{0.0});
  visit("unit", o.unit, "frames (pairs in a row), seconds or metres of path");
  visit("tolerance", o.tolerance, "how far s and m may miss, as part of delta [-]", Between{0.0});
  visit("frame", o.frame, "frame of the single axes");
  visit("distance_of", o.distance_of, "whose path measures metres");
}

/// With Q the reference, P the estimate and E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), evo's form:
/// translation 3d [m] |trans(E)|, rotation 3d [deg] angle(E), translation x, y, z [m] magnitudes
/// in `frame`. All pairs: every i with the later j that is `delta` frames on, or nearest to
/// `delta` seconds of reference stamps or metres and within tolerance (see pair_search.hpp; evo's
/// rule, with distance_of = estimate for its default). Pairs from the reference are the same for
/// every method. Throws OptionError when delta is not whole for frames, std::runtime_error when no
/// two poses are that far apart. For positions without attitude (position_only.hpp) only world
/// axes are defined. O(n log n).
std::vector<Score> rpe(const Evaluation& evaluation, const RpeOptions& options);

}  // namespace loopbench
