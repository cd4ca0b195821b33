/// Quintic bridge between two pieces through their node, and the ramp that shifts the ends of a
/// piece.
#pragma once

#include <array>

#include "methods/smoothers/manifold/jet.hpp"

namespace loopbench::methods::manifold {

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

}  // namespace loopbench::methods::manifold
