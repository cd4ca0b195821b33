#include "methods/smoothers/manifold/families/implicit.hpp"

#include <Eigen/Eigenvalues>
#include <array>
#include <vector>

namespace loopbench::methods::manifold {
namespace {

struct Monomials {
  Parameters value, by_x, by_y;
};

Monomials monomials(int order, const Vector2& u) {
  std::array<double, 4> x{1.0, u.x(), u.x() * u.x(), u.x() * u.x() * u.x()};
  std::array<double, 4> y{1.0, u.y(), u.y() * u.y(), u.y() * u.y() * u.y()};
  const Eigen::Index terms = implicit_terms(order);
  Monomials out{Parameters(terms), Parameters(terms), Parameters(terms)};
  for (Eigen::Index k = 0; k < terms; ++k) {
    const auto [i, j] = implicit_powers(order, k);
    const auto a = static_cast<std::size_t>(i);
    const auto b = static_cast<std::size_t>(j);
    out.value[k] = x[a] * y[b];
    out.by_x[k] = i > 0 ? i * x[a - 1] * y[b] : 0.0;
    out.by_y[k] = j > 0 ? j * x[a] * y[b - 1] : 0.0;
  }
  return out;
}

using Square =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxParameters, kMaxParameters>;

Parameters taubin(const Square& values, const Square& gradients) {
  // Largest eigenvalue of gradients relative to values: in this order the zero row of the constant
  // term in `gradients` is harmless, and a small regularisation keeps exact fits nonsingular.
  const Eigen::Index terms = values.rows();
  const Square weight = values + 1e-14 * values.trace() * Square::Identity(terms, terms);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Square> solver(gradients, weight);
  return solver.eigenvectors().col(terms - 1).normalized();
}

void sampson(
    std::span<const Vector2> us, int order, const Parameters& a, FamilyResiduals& r, Slopes& J) {
  for (std::size_t k = 0; k < us.size(); ++k) {
    const Monomials m = monomials(order, us[k]);
    const double f = a.dot(m.value);
    const Vector2 g(a.dot(m.by_x), a.dot(m.by_y));
    const double size = std::max(g.norm(), 1e-12);
    const auto i = static_cast<Eigen::Index>(k);
    r[i] = f / size;
    J.row(i) =
        (m.value / size - f / (size * size * size) * (g.x() * m.by_x + g.y() * m.by_y)).transpose();
  }
}

}  // namespace

std::pair<int, int> implicit_powers(int order, Eigen::Index k) {
  for (int degree = order; degree > 0; --degree) {
    if (k <= degree) return {degree - static_cast<int>(k), static_cast<int>(k)};
    k -= degree + 1;
  }
  return {0, 0};
}

std::optional<Implicit> fit_implicit(std::span<const Vector2> points, int order) {
  const Eigen::Index terms = implicit_terms(order);
  const auto count = static_cast<Eigen::Index>(points.size());
  if (count < terms - 1 || count > kMaxNodes) return std::nullopt;
  const Extent extent(points);
  Implicit out{order, extent.centre(), 0.5 * extent.size().maxCoeff(), {}};
  if (!(out.scale > 0.0)) return std::nullopt;
  std::vector<Vector2> us;
  Square values = Square::Zero(terms, terms);
  Square gradients = Square::Zero(terms, terms);
  for (const Vector2& point : points) {
    us.push_back((point - out.centre) / out.scale);
    const Monomials m = monomials(order, us.back());
    values += m.value * m.value.transpose();
    gradients += m.by_x * m.by_x.transpose() + m.by_y * m.by_y.transpose();
  }
  const Parameters start = taubin(values, gradients);
  if (!start.allFinite()) return std::nullopt;
  out.alpha = levenberg_marquardt(
      start, count, [&](const auto& a, auto& r, auto& J) { sampson(us, order, a, r, J); });
  out.alpha.normalize();
  if (!out.alpha.allFinite()) return std::nullopt;
  return out;
}

}  // namespace loopbench::methods::manifold
