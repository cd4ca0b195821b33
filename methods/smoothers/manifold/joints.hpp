/// Step 10: joints between neighbouring pieces, and the piecewise curve that they form.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "methods/smoothers/manifold/families/jet.hpp"
#include "methods/smoothers/manifold/windows.hpp"

namespace loopbench::methods::manifold {

/// overlap_blend: neighbouring pieces overlap and are blended, C2. quintic_bridge: half a step on
/// each side of the joint is replaced by a quintic; both meet at the node, C2. c0: both pieces are
/// shifted by half of their gap. none: pieces are not joined.
enum class JointKind { overlap_blend, quintic_bridge, c0, none };
inline auto choices(JointKind) {
  return std::array{std::pair{"overlap_blend", JointKind::overlap_blend},
                    std::pair{"quintic_bridge", JointKind::quintic_bridge},
                    std::pair{"c0", JointKind::c0},
                    std::pair{"none", JointKind::none}};
}

struct JointRule {
  JointKind kind = JointKind::overlap_blend;
  std::optional<double> c0_below = std::nullopt;  ///< speed below which joints are C0 [m/s]

  /// Joint type at `node`, depending on the mean speed over its two steps.
  JointKind at(const Nodes& nodes, std::size_t node) const {
    if (!c0_below) return kind;
    const double length = nodes.step(node - 1).norm() + nodes.step(node).norm();
    const double duration = nodes.stamps[node + 1] - nodes.stamps[node - 1];
    return length / duration < *c0_below ? JointKind::c0 : kind;
  }
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
inline Joint joint_between(const Nodes& nodes, const Window& before, const Window& after) {
  const std::size_t node = after.owned.first;
  const double step_before = nodes.step(node - 1).norm();
  const double step_after = nodes.step(node).norm();
  const auto extension = [](double own_step, double next_step) {
    return next_step > own_step ? own_step / next_step : 1.0;
  };
  const double extension_back =
      after.fitted.first < node ? 1.0 : extension(step_after, step_before);
  const double extension_forward =
      before.fitted.last > node ? 1.0 : extension(step_before, step_after);
  return {nodes.stamps[node] - extension_back * nodes.duration(node - 1),
          nodes.stamps[node] + extension_forward * nodes.duration(node)};
}

/// Joint between two windows of one edge each. Windows around nodes (`size` odd) are blended over
/// the complete earlier edge. Windows around edges are blended from edge middle to edge middle, as
/// is a straight line between two nodes, which carries no information about the edges next to it.
inline Joint sliding_joint(const Nodes& nodes,
                           const Window& before,
                           const Window& after,
                           std::size_t size) {
  const std::size_t node = after.owned.first;
  const bool has_line = before.fitted.nodes() == 2 || after.fitted.nodes() == 2;
  if (size % 2 == 1 && !has_line) return {nodes.stamps[node - 1], nodes.stamps[node]};
  return {nodes.stamps[node] - 0.5 * nodes.duration(node - 1),
          nodes.stamps[node] + 0.5 * nodes.duration(node)};
}

/// Result type of a function of time: Value for a double, Jet<Value> for a Jet.
template <class T, class Value>
using Asked = std::conditional_t<std::is_same_v<T, double>, Value, Jet<Value>>;

/// Quintic Hermite polynomial: value and two derivatives at both ends. Empty if begin == end.
template <class Value>
struct Bridge {
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]
  std::array<Value, 6> c{};

  Bridge() = default;
  Bridge(double from, double to, const Jet<Value>& a, const Jet<Value>& b) : begin(from), end(to) {
    const double h = end - begin;
    const Value v0 = h * a.first, v1 = h * b.first;
    const Value w0 = 0.5 * h * h * a.second, w1 = 0.5 * h * h * b.second;
    const Value gap = b.value - a.value;
    c = {a.value,
         v0,
         w0,
         10.0 * gap - 6.0 * v0 - 4.0 * v1 - 3.0 * w0 + w1,
         -15.0 * gap + 8.0 * v0 + 7.0 * v1 + 3.0 * w0 - 2.0 * w1,
         6.0 * gap - 3.0 * v0 - 3.0 * v1 - w0 + w1};
  }

  bool spans(double time) const { return begin < time && time < end; }

  template <class T>
  Asked<T, Value> operator()(const T& time) const {
    const T s = (time - begin) / (end - begin);
    return c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * c[5]))));
  }
};

/// Two quintics from one piece to the next that meet at the node with the mean of both pieces'
/// values, velocities and accelerations: C2, and through the node if both pieces are. Empty if
/// default constructed.
template <class Value>
struct BridgeOverNode {
  Bridge<Value> before, after;

  bool spans(double time) const { return before.begin < time && time < after.end; }

  template <class T>
  Asked<T, Value> operator()(const T& time) const {
    return value_of(time) < before.end ? before(time) : after(time);
  }
};

/// Offset that is added to a piece so that it meets its neighbours; linear over the piece's own
/// time span.
template <class Value>
struct Ramp {
  double from = 0.0, to = 1.0;  ///< [s]
  Value begin{}, end{};

  template <class T>
  Asked<T, Value> operator()(const T& time) const {
    const T s = (time - from) / (to - from);
    return begin + s * Value(end - begin);
  }
};

template <class Piece, class Value>
struct PiecewiseCurve {
  std::vector<Piece> pieces;
  std::vector<Joint> joints;  ///< joints[k] is between pieces k and k + 1
  std::vector<std::uint32_t> piece_of_edge;
  std::vector<Ramp<Value>> ramps;              ///< one per piece, or empty
  std::vector<BridgeOverNode<Value>> bridges;  ///< one per joint, or empty

  /// Value of piece k plus its ramp.
  template <class T, class Ask>
  Asked<T, Value> alone(std::size_t k, const T& time, Ask ask) const {
    if (ramps.empty()) return ask(pieces[k]);
    return ask(pieces[k]) + ramps[k](time);
  }

  /// Value of the curve: `ask(piece)`, blended or bridged at joints. Blending keeps a node that
  /// both pieces interpolate. O(1), at most three pieces.
  template <class T, class Ask>
  Asked<T, Value> at(std::size_t edge, const T& time, Ask ask) const {
    const std::size_t k = piece_of_edge[edge];
    const double now = value_of(time);
    if (!bridges.empty()) {
      if (k > 0 && bridges[k - 1].spans(now)) return bridges[k - 1](time);
      if (k < bridges.size() && bridges[k].spans(now)) return bridges[k](time);
    }
    Asked<T, Value> out = alone(k, time, ask);
    if (k > 0 && now < joints[k - 1].end) {
      const T w = joints[k - 1].weight(time);
      out = (1.0 - w) * alone(k - 1, time, ask) + w * out;
    }
    if (k < joints.size() && now > joints[k].begin) {
      const T w = joints[k].weight(time);
      out = (1.0 - w) * out + w * alone(k + 1, time, ask);
    }
    return out;
  }
};

/// Placement and joints of windows.
struct JoinOptions {
  JointRule rule;
  Scheme scheme = Scheme::consecutive;
  std::size_t size = 4;  ///< number of nodes of a window
};

/// Joins pieces that were fitted to windows, in time order and covering every edge. `ask(piece,
/// edge, time)` evaluates a piece at a Jet of time, from which ramps and bridges are computed.
template <class Value, class Piece, class Ask>
PiecewiseCurve<Piece, Value> join_pieces(const Nodes& nodes,
                                         const std::vector<Window>& windows,
                                         std::vector<Piece> pieces,
                                         const JoinOptions& join,
                                         Ask ask) {
  PiecewiseCurve<Piece, Value> out;
  out.pieces = std::move(pieces);
  out.piece_of_edge.reserve(nodes.size());
  const bool ramped = join.rule.kind == JointKind::c0 || join.rule.c0_below;
  if (ramped) out.ramps.resize(windows.size());
  if (join.rule.kind == JointKind::quintic_bridge) out.bridges.resize(windows.size() - 1);
  for (std::size_t k = 0; k < windows.size(); ++k) {
    const NodeRange& owned = windows[k].owned;
    out.piece_of_edge.resize(owned.last, static_cast<std::uint32_t>(k));
    if (ramped) {
      out.ramps[k].from = nodes.stamps[owned.first];
      out.ramps[k].to = nodes.stamps[owned.last];
      if constexpr (!std::is_same_v<Value, double>) {
        out.ramps[k].begin.setZero();
        out.ramps[k].end.setZero();
      }
    }
    if (k == 0) continue;
    const double now = nodes.stamps[owned.first];
    const JointKind kind = join.rule.at(nodes, owned.first);
    if (kind == JointKind::c0) {
      const auto before = ask(out.pieces[k - 1], owned.first - 1, time_jet(now));
      const auto after = ask(out.pieces[k], owned.first, time_jet(now));
      const Value half = 0.5 * (after.value - before.value);
      out.ramps[k - 1].end = half;
      out.ramps[k].begin = -half;
    }
    if (kind != JointKind::overlap_blend) {
      out.joints.push_back({now, now});
    } else if (join.scheme == Scheme::sliding_blend) {
      out.joints.push_back(sliding_joint(nodes, windows[k - 1], windows[k], join.size));
    } else {
      out.joints.push_back(joint_between(nodes, windows[k - 1], windows[k]));
    }
  }
  for (std::size_t k = 0; k < out.bridges.size(); ++k) {
    const std::size_t node = windows[k + 1].owned.first;
    if (join.rule.at(nodes, node) != JointKind::quintic_bridge) continue;
    const double half = 0.5 * std::min(nodes.duration(node - 1), nodes.duration(node));
    const auto begin = time_jet(nodes.stamps[node] - half);
    const auto middle = time_jet(nodes.stamps[node]);
    const auto end = time_jet(nodes.stamps[node] + half);
    const auto value_of_piece = [&](std::size_t piece, std::size_t edge, const Jet<double>& time) {
      return out.alone(piece, time, [&](const Piece& p) { return ask(p, edge, time); });
    };
    const Jet<Value> a = value_of_piece(k, node - 1, middle);
    const Jet<Value> b = value_of_piece(k + 1, node, middle);
    const Jet<Value> mean{
        0.5 * (a.value + b.value), 0.5 * (a.first + b.first), 0.5 * (a.second + b.second)};
    out.bridges[k] = {{begin.value, middle.value, value_of_piece(k, node - 1, begin), mean},
                      {middle.value, end.value, mean, value_of_piece(k + 1, node, end)}};
  }
  return out;
}

}  // namespace loopbench::methods::manifold
