#include "methods/smoothers/manifold/families/implicit.hpp"

#include <Eigen/Eigenvalues>
#include <vector>

namespace loopbench::methods::manifold {
namespace {

constexpr Eigen::Index kTerms = kImplicitPowers.size();

struct Monomials {
  Parameters value, by_x, by_y;
};

Monomials monomials(const Vector2& u) {
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

Parameters taubin(const Square& values, const Square& gradients) {
  // Largest eigenvalue of gradients relative to values: in this order the zero row of the constant
  // term in `gradients` is harmless, and a small regularisation keeps exact fits nonsingular.
  const Eigen::Index terms = values.rows();
  const Square weight = values + 1e-14 * values.trace() * Square::Identity(terms, terms);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Square> solver(gradients, weight);
  return solver.eigenvectors().col(terms - 1).normalized();
}

void sampson(std::span<const Vector2> us, const Parameters& a, FamilyResiduals& r, Slopes& J) {
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

}  // namespace

std::optional<Implicit> fit_implicit(std::span<const Vector2> points) {
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
