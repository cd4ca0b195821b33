/// Step 10: how neighbouring pieces meet.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "methods/smoothers/manifold/jet.hpp"
#include "methods/smoothers/manifold/windows.hpp"

namespace loopbench::manifold {

/// overlap_blend: pieces reach into each other and blend, C2. quintic_bridge: half a step around
/// the joint is replaced by a quintic, C2. constrained_ls: all pieces are one cubic regression
/// spline, C2 (regression.hpp). c0: each piece is moved to meet its neighbour half way. none.
enum class Meet { overlap_blend, quintic_bridge, constrained_ls, c0, none };
inline auto choices(Meet) {
  return std::array{std::pair{"overlap_blend", Meet::overlap_blend},
                    std::pair{"quintic_bridge", Meet::quintic_bridge},
                    std::pair{"constrained_ls", Meet::constrained_ls},
                    std::pair{"c0", Meet::c0},
                    std::pair{"none", Meet::none}};
}

struct JointRule {
  Meet meet = Meet::overlap_blend;
  std::optional<double> c0_below =
      std::nullopt;  ///< slower joints only meet in position [m/s]; none: no such

  /// How the pieces before and after `node` meet, by the speed over its two steps.
  Meet at(const Nodes& nodes, std::size_t node) const;
};

/// Where one piece hands over to the next: around their shared node, never beyond its two edges.
struct Joint {
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]; `begin` for a sharp joint

  /// Share of the later piece: 6 s^5 - 15 s^4 + 10 s^3, flat to second order at both ends.
  template <class T>
  T weight(const T& time) const {
    const double at = value_of(time);
    if (at <= begin) return 0.0 * time;
    if (at >= end) return 0.0 * time + 1.0;
    const T s = (time - begin) / (end - begin);
    return s * s * s * (10.0 + s * (6.0 * s - 15.0));
  }
};

/// The joint between two neighbouring windows. Each piece reaches one node past its window, but
/// where the next step is longer than its own last one only that far: a parabola over nodes that
/// stand close says nothing about a far one. A window that has the neighbour's node among its own
/// is not extended there at all.
Joint joint_between(const Nodes& nodes, const Window& before, const Window& after);

/// The joint between two windows of one edge each. Windows around nodes (`size` odd) blend over the
/// whole earlier edge, from its one node to the other; windows around edges from middle to middle,
/// and so does a straight line between two nodes, which says nothing about the edges beside it.
Joint sliding_joint(const Nodes& nodes,
                    const Window& before,
                    const Window& after,
                    std::size_t size);

}  // namespace loopbench::manifold
