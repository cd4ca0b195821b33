/// Step 10: joints between neighbouring pieces.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "methods/smoothers/manifold/jet.hpp"
#include "methods/smoothers/manifold/windows.hpp"

namespace loopbench::methods::manifold {

/// overlap_blend: neighbouring pieces overlap and are blended, C2. quintic_bridge: half a step on
/// each side of the joint is replaced by a quintic; both meet at the node, C2. constrained_ls: all
/// pieces are one cubic regression spline, C2 (dm.cpp). c0: both pieces are shifted by half
/// of their gap. none: pieces are not joined.
enum class JointKind { overlap_blend, quintic_bridge, constrained_ls, c0, none };
inline auto choices(JointKind) {
  return std::array{std::pair{"overlap_blend", JointKind::overlap_blend},
                    std::pair{"quintic_bridge", JointKind::quintic_bridge},
                    std::pair{"constrained_ls", JointKind::constrained_ls},
                    std::pair{"c0", JointKind::c0},
                    std::pair{"none", JointKind::none}};
}

struct JointRule {
  JointKind kind = JointKind::overlap_blend;
  std::optional<double> c0_below = std::nullopt;  ///< speed below which joints are C0 [m/s]

  /// Joint type at `node`, depending on the mean speed over its two steps.
  JointKind at(const Nodes& nodes, std::size_t node) const;
};

/// Transition from one piece to the next around their shared node, within its two edges.
struct Joint {
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]; equal to `begin` for a sharp joint

  /// Weight of the later piece: 6 s^5 - 15 s^4 + 10 s^3, with zero first and second derivatives at
  /// both ends.
  template <class T>
  T weight(const T& time) const {
    const double at = value_of(time);
    if (at <= begin) return 0.0 * time;
    if (at >= end) return 0.0 * time + 1.0;
    const T s = (time - begin) / (end - begin);
    return s * s * s * (10.0 + s * (6.0 * s - 15.0));
  }
};

/// Joint between two neighbouring windows. Each piece extends one node past its window, but at most
/// by the length of its own last step, because a parabola through close nodes extrapolates badly
/// over a long step. A piece is not extended if its window already contains the neighbour's node.
Joint joint_between(const Nodes& nodes, const Window& before, const Window& after);

/// Joint between two windows of one edge each. Windows around nodes (`size` odd) are blended over
/// the complete earlier edge. Windows around edges are blended from edge middle to edge middle, as
/// is a straight line between two nodes, which carries no information about the edges next to it.
Joint sliding_joint(const Nodes& nodes,
                    const Window& before,
                    const Window& after,
                    std::size_t size);

}  // namespace loopbench::methods::manifold
