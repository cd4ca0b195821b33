/// The parametric fallback arc: r(s) = c0 + c1 s + c2 s^2, where s is the arc length along the
/// nodes.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "methods/smoothers/manifold/jet.hpp"
#include "methods/smoothers/manifold/nodes.hpp"

namespace loopbench::methods::manifold {

/// Parabola through three points in Newton's form, which is stable when two of them nearly coincide
/// because every divided difference is bounded by a chord length.
struct Arc {
  std::array<double, 2> s{};            ///< first and second node [m]
  std::array<Vector3, 3> difference{};  ///< divided differences of order 0, 1, 2

  template <class T>
  VectorOf<T> operator()(const T& arc_length) const {
    return difference[0] +
           (arc_length - s[0]) * (difference[1] + (arc_length - s[1]) * difference[2]);
  }
};

/// Fits the parabola to three points and their arc lengths [m]. Returns nullopt when two coincide.
inline std::optional<Arc> fit_arc(std::span<const Vector3, 3> r, std::span<const double, 3> s) {
  if (!(s[1] > s[0]) || !(s[2] > s[1])) return std::nullopt;
  const Vector3 first = (r[1] - r[0]) / (s[1] - s[0]);
  const Vector3 second = (r[2] - r[1]) / (s[2] - s[1]);
  return Arc{{s[0], s[1]}, {r[0], first, (second - first) / (s[2] - s[0])}};
}

}  // namespace loopbench::methods::manifold
