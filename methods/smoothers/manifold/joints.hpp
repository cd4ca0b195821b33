/// Step 10: neighbouring pieces overlap and blend, so the curve is C2 where they meet.
#pragma once

#include <cstdint>

#include "methods/smoothers/manifold/windows.hpp"

namespace loopbench::manifold {

/// Where one piece hands over to the next: around their shared node, never beyond its two edges.
struct Joint {
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]

  /// Share of the later piece: 6 s^5 - 15 s^4 + 10 s^3, flat to second order at both ends.
  double weight(double time) const {
    const double s = (time - begin) / (end - begin);
    return s <= 0.0 ? 0.0 : s >= 1.0 ? 1.0 : s * s * s * (10.0 + s * (6.0 * s - 15.0));
  }
};

/// The joint between two neighbouring windows. Each piece reaches one node past its window, but
/// where the next step is longer than its own last one only that far: a parabola over nodes that
/// stand close says nothing about a far one. A window that has the neighbour's node among its own
/// is not extended there at all.
Joint joint_between(const Nodes& nodes, const Window& before, const Window& after);

/// Pieces laid end to end in time with a joint between each two.
template <class Piece>
struct Strip {
  std::vector<Piece> pieces;
  std::vector<Joint> joints;  ///< joints[k] is between pieces k and k + 1
  std::vector<std::uint32_t> piece_of_edge;

  /// `value(piece)` blended where pieces meet. Pieces that meet in a node which both pass through
  /// leave it where it is, whatever the weights. O(1), three pieces at most.
  template <class Value>
  auto at(std::size_t edge, double time, Value value) const {
    const std::size_t k = piece_of_edge[edge];
    auto out = value(pieces[k]);
    if (k > 0 && time < joints[k - 1].end) {
      const double w = joints[k - 1].weight(time);
      out = (1.0 - w) * value(pieces[k - 1]) + w * out;
    }
    if (k < joints.size() && time > joints[k].begin) {
      const double w = joints[k].weight(time);
      out = (1.0 - w) * out + w * value(pieces[k + 1]);
    }
    return out;
  }
};

/// Pieces and the windows they were fitted to, both in time order and covering every edge.
template <class Piece>
Strip<Piece> joined(const Nodes& nodes,
                    const std::vector<Window>& windows,
                    std::vector<Piece> pieces) {
  Strip<Piece> out;
  out.pieces = std::move(pieces);
  out.piece_of_edge.reserve(nodes.size());
  for (std::size_t k = 0; k < windows.size(); ++k) {
    if (k > 0) out.joints.push_back(joint_between(nodes, windows[k - 1], windows[k]));
    out.piece_of_edge.resize(windows[k].owned.last, static_cast<std::uint32_t>(k));
  }
  return out;
}

}  // namespace loopbench::manifold
