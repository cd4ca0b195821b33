/// The family F(x, y) = sum over i + j <= 2 of alpha(i,j) x^i y^j = 0, equation (9).
#pragma once

#include <Eigen/Eigenvalues>
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "methods/smoothers/manifold/families/fitting.hpp"
#include "methods/smoothers/manifold/families/jet.hpp"

namespace loopbench::methods::manifold {

/// Powers (i, j) of the monomials in the article's order: x^2, xy, y^2, x, y, 1.
inline constexpr std::array<std::pair<std::size_t, std::size_t>, 6> kImplicitPowers{
    {{2, 0}, {1, 1}, {0, 2}, {1, 0}, {0, 1}, {0, 0}}};

struct Implicit {
  Vector2 centre = Vector2::Zero();  ///< origin of the scaled coordinates [m]
  double scale = 1.0;                ///< common scale of both coordinates [m]
  Parameters alpha;                  ///< |alpha| = 1

  /// F and its gradient with respect to scaled coordinates.
  template <class T>
  struct Evaluation {
    T f, by_u, by_v;
  };
  template <class T>
  Evaluation<T> evaluate(const T& u, const T& v) const {
    const T zero = 0.0 * u;
    const std::array<T, 3> x{zero + 1.0, u, u * u};
    const std::array<T, 3> y{zero + 1.0, v, v * v};
    Evaluation<T> out{zero, zero, zero};
    for (Eigen::Index k = 0; k < alpha.size(); ++k) {
      const auto [i, j] = kImplicitPowers[static_cast<std::size_t>(k)];
      out.f = out.f + alpha[k] * (x[i] * y[j]);
      if (i > 0) out.by_u = out.by_u + (static_cast<double>(i) * alpha[k]) * (x[i - 1] * y[j]);
      if (j > 0) out.by_v = out.by_v + (static_cast<double>(j) * alpha[k]) * (x[i] * y[j - 1]);
    }
    return out;
  }

  /// Returns the point of the curve near (x, y), by steps along the gradient until F is zero to
  /// rounding. For jets the derivatives converge one step later. Returns nullopt when the steps do
  /// not converge, for example near a singular point of the curve.
  template <class T>
  std::optional<std::pair<T, T>> nearest(const T& x, const T& y) const {
    constexpr int steps = 30;
    constexpr double close = 1e-12;  // [of the scale]
    T u = (x - centre.x()) / scale;
    T v = (y - centre.y()) / scale;
    int converged_steps = 0;
    for (int i = 0; i < steps; ++i) {
      const Evaluation<T> at = evaluate(u, v);
      const T step_factor = at.f * (1.0 / (at.by_u * at.by_u + at.by_v * at.by_v));
      const T du = step_factor * at.by_u;
      const T dv = step_factor * at.by_v;
      const double step = std::hypot(value_of(du), value_of(dv));
      if (!(step < 1.0)) return std::nullopt;
      u = u - du;
      v = v - dv;
      if (step < close) ++converged_steps;
      if (converged_steps == 3) return std::pair{scale * u + centre.x(), scale * v + centre.y()};
    }
    return std::nullopt;
  }
};

inline constexpr Eigen::Index kTerms = kImplicitPowers.size();

struct Monomials {
  Parameters value, by_x, by_y;
};

inline Monomials monomials(const Vector2& u) {
  const std::array<double, 3> x{1.0, u.x(), u.x() * u.x()};
  const std::array<double, 3> y{1.0, u.y(), u.y() * u.y()};
  Monomials out{Parameters(kTerms), Parameters(kTerms), Parameters(kTerms)};
  for (Eigen::Index k = 0; k < kTerms; ++k) {
    const auto [i, j] = kImplicitPowers[static_cast<std::size_t>(k)];
    out.value[k] = x[i] * y[j];
    out.by_x[k] = i > 0 ? static_cast<double>(i) * x[i - 1] * y[j] : 0.0;
    out.by_y[k] = j > 0 ? static_cast<double>(j) * x[i] * y[j - 1] : 0.0;
  }
  return out;
}

using Square =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxParameters, kMaxParameters>;

inline Parameters taubin(const Square& values, const Square& gradients) {
  // Largest eigenvalue of gradients relative to values: in this order the zero row of the constant
  // term in `gradients` is harmless, and a small regularisation keeps exact fits nonsingular.
  const Eigen::Index terms = values.rows();
  const Square weight = values + 1e-14 * values.trace() * Square::Identity(terms, terms);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Square> solver(gradients, weight);
  return solver.eigenvectors().col(terms - 1).normalized();
}

inline void sampson(std::span<const Vector2> us,
                    const Parameters& a,
                    FamilyResiduals& r,
                    Slopes& J) {
  for (std::size_t k = 0; k < us.size(); ++k) {
    const Monomials m = monomials(us[k]);
    const double f = a.dot(m.value);
    const Vector2 g(a.dot(m.by_x), a.dot(m.by_y));
    const double size = std::max(g.norm(), 1e-12);
    const auto i = static_cast<Eigen::Index>(k);
    r[i] = f / size;
    J.row(i) =
        (m.value / size - f / (size * size * size) * (g.x() * m.by_x + g.y() * m.by_y)).transpose();
  }
}

/// Taubin's fit (the eigenvector that minimises F^2 over the squared gradient), followed by
/// Levenberg-Marquardt on the Sampson distance F / |grad F|, the first-order approximation of the
/// distance to the curve. Requires five to twelve points. Returns nullopt for fewer points or
/// points without extent. Source: Taubin, PAMI 13(11) 1991; Sampson, CGIP 18 1982.
inline std::optional<Implicit> fit_implicit(std::span<const Vector2> points) {
  const auto count = static_cast<Eigen::Index>(points.size());
  if (count < kTerms - 1 || count > kMaxNodes) return std::nullopt;
  const Extent extent(points);
  Implicit out{extent.centre(), 0.5 * extent.size().maxCoeff(), {}};
  if (!(out.scale > 0.0)) return std::nullopt;
  std::vector<Vector2> us;
  Square values = Square::Zero(kTerms, kTerms);
  Square gradients = Square::Zero(kTerms, kTerms);
  for (const Vector2& point : points) {
    us.push_back((point - out.centre) / out.scale);
    const Monomials m = monomials(us.back());
    values += m.value * m.value.transpose();
    gradients += m.by_x * m.by_x.transpose() + m.by_y * m.by_y.transpose();
  }
  const Parameters start = taubin(values, gradients);
  if (!start.allFinite()) return std::nullopt;
  out.alpha = levenberg_marquardt(
      start, count, [&](const auto& a, auto& r, auto& J) { sampson(us, a, r, J); });
  out.alpha.normalize();
  if (!out.alpha.allFinite()) return std::nullopt;
  return out;
}

}  // namespace loopbench::methods::manifold
