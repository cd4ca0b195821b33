/// The parametric fallback arc-poly: r(s) = c0 + c1 s + c2 s^2, s the way along the nodes.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "methods/smoothers/manifold/jet.hpp"
#include "methods/smoothers/manifold/nodes.hpp"

namespace loopbench::manifold {

/// The parabola through three points in Newton's form, which stays tame when two of them nearly
/// coincide: chord length bounds every divided difference.
struct Arc {
  std::array<double, 2> s{};            ///< first and second node [m]
  std::array<Vector3, 3> difference{};  ///< divided differences of order 0, 1, 2

  template <class T>
  VectorOf<T> operator()(const T& way) const {
    return difference[0] + (way - s[0]) * (difference[1] + (way - s[1]) * difference[2]);
  }
};

/// Three points and the way [m] to each of them. Nothing when two coincide.
inline std::optional<Arc> fit_arc(std::span<const Vector3, 3> r, std::span<const double, 3> s) {
  if (!(s[1] > s[0]) || !(s[2] > s[1])) return std::nullopt;
  const Vector3 first = (r[1] - r[0]) / (s[1] - s[0]);
  const Vector3 second = (r[2] - r[1]) / (s[2] - s[1]);
  return Arc{{s[0], s[1]}, {r[0], first, (second - first) / (s[2] - s[0])}};
}

}  // namespace loopbench::manifold
