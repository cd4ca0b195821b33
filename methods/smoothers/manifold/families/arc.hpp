/// Parametric curves r(s), where s is the arc length along the nodes: the fallback arc and the
/// family arc-poly.
#pragma once

#include <Eigen/QR>
#include <array>
#include <optional>
#include <span>

#include "methods/smoothers/manifold/families/levenberg_marquardt.hpp"
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

struct ArcPolynomial {
  double centre = 0.0;                    ///< [m]
  double scale = 1.0;                     ///< [m]
  std::array<Vector3, 4> coefficients{};  ///< of powers of u = (s - centre) / scale [m]

  template <class T>
  VectorOf<T> operator()(const T& arc_length) const {
    const T u = (arc_length - centre) / scale;
    const auto& c = coefficients;
    return c[0] + u * (c[1] + u * (c[2] + u * c[3]));
  }
};

/// Least-squares fit in space by QR to at most twelve points. The degree is reduced to the number
/// of points - 1. Returns nullopt when two arc lengths coincide.
inline std::optional<ArcPolynomial> fit_arc_polynomial(std::span<const Vector3> points,
                                                       std::span<const double> arc_lengths,
                                                       int degree) {
  for (std::size_t i = 1; i < arc_lengths.size(); ++i) {
    if (!(arc_lengths[i] > arc_lengths[i - 1])) return std::nullopt;
  }
  const auto count = static_cast<Eigen::Index>(points.size());
  const Eigen::Index terms = std::min<Eigen::Index>(degree + 1, count);
  ArcPolynomial out;
  out.coefficients.fill(Vector3::Zero());
  out.centre = 0.5 * (arc_lengths.front() + arc_lengths.back());
  out.scale = 0.5 * (arc_lengths.back() - arc_lengths.front());
  if (count < 2) return std::nullopt;
  Slopes powers(count, terms);
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMaxNodes, 3> right(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    right.row(i) = points[k].transpose();
    powers(i, 0) = 1.0;
    for (Eigen::Index j = 1; j < terms; ++j) {
      powers(i, j) = powers(i, j - 1) * (arc_lengths[k] - out.centre) / out.scale;
    }
  }
  const Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMaxParameters, 3> solved =
      powers.householderQr().solve(right);
  for (Eigen::Index j = 0; j < terms; ++j) {
    out.coefficients[static_cast<std::size_t>(j)] = solved.row(j).transpose();
  }
  return out;
}

}  // namespace loopbench::methods::manifold
