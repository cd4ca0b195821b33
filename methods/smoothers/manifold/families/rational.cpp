#include <Eigen/QR>

#include "methods/smoothers/manifold/families/fitting.hpp"
#include "methods/smoothers/manifold/families/graph.hpp"

namespace loopbench::methods::manifold {
namespace {

bool has_pole(double q1, double q2) {
  const double discriminant = 0.25 * q1 * q1 - q2;
  if (discriminant < 0.0) return false;
  constexpr double reach = 1.0 + 2.0 * kPoleMargin;  // u runs from -1 to 1
  const double root = std::sqrt(discriminant);
  return std::abs(-0.5 * q1 - root) <= reach || std::abs(-0.5 * q1 + root) <= reach;
}

// Poles tried on each side, in half ranges from the middle. The last one is practically a line.
constexpr double kFirst = 1.0 + 2.0 * kPoleMargin;
constexpr double kLast = 100.0;
constexpr int kHyperbolaStarts = 8;

}  // namespace

std::optional<Rational> fit_rational(std::span<const Vector2> points) {
  const auto count = static_cast<Eigen::Index>(points.size());
  if (count < 4 || count > kMaxNodes) return std::nullopt;
  const Extent extent(points);
  Rational out;
  out.centre = extent.centre().x();
  out.scale = 0.5 * extent.size().x();
  if (!(out.scale > 0.0)) return std::nullopt;
  const auto u = [&](Eigen::Index i) {
    return (points[static_cast<std::size_t>(i)].x() - out.centre) / out.scale;
  };
  const auto y = [&](Eigen::Index i) { return points[static_cast<std::size_t>(i)].y(); };

  // y (u^2 + q1 u + q2) = p: linear in q1, q2 and p.
  Slopes design(count, 3);
  FamilyResiduals right(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    design.row(i) << u(i) * y(i), y(i), -1.0;
    right[i] = -y(i) * u(i) * u(i);
  }
  Parameters start = design.colPivHouseholderQr().solve(right);
  // Descent cannot cross a pole, so start from a wide bell instead.
  if (!start.allFinite() || has_pole(start[0], start[1])) start << 0.0, 4.0, 4.0 * y(0);

  const Parameters q = levenberg_marquardt(start, count, [&](const auto& q_, auto& r, auto& J) {
    for (Eigen::Index i = 0; i < count; ++i) {
      const double inverse = 1.0 / (u(i) * (u(i) + q_[0]) + q_[1]);
      const double value = q_[2] * inverse;
      r[i] = value - y(i);
      J(i, 0) = -value * inverse * u(i);
      J(i, 1) = -value * inverse;
      J(i, 2) = inverse;
    }
  });
  if (!q.allFinite() || has_pole(q[0], q[1])) return std::nullopt;
  out.q1 = q[0];
  out.q2 = q[1];
  out.p = q[2];
  return out;
}

std::optional<Hyperbola> fit_hyperbola(std::span<const Vector2> points) {
  const auto count = static_cast<Eigen::Index>(points.size());
  if (count < 4 || count > kMaxNodes) return std::nullopt;
  const Extent extent(points);
  const double centre = extent.centre().x();
  const double scale = 0.5 * extent.size().x();
  if (!(scale > 0.0)) return std::nullopt;
  // The parameters are the pole in half ranges from the middle, c0 and c1.
  const auto evaluate = [&](const Parameters& q, FamilyResiduals& r, Slopes& J) {
    for (Eigen::Index i = 0; i < count; ++i) {
      const Vector2& point = points[static_cast<std::size_t>(i)];
      const double inverse = 1.0 / ((point.x() - centre) / scale - q[0]);
      r[i] = q[1] + q[2] * inverse - point.y();
      J.row(i) << q[2] * inverse * inverse, 1.0, inverse;
    }
  };
  Parameters best;
  double lowest = std::numeric_limits<double>::infinity();
  for (int start = 0; start < 2 * kHyperbolaStarts; ++start) {
    Parameters q = Parameters::Zero(3);
    q[0] = kFirst * std::pow(kLast / kFirst, (start / 2) / (kHyperbolaStarts - 1.0));
    if (start % 2 == 1) q[0] = -q[0];
    FamilyResiduals r(count);
    Slopes J(count, 3);
    evaluate(q, r, J);
    const Slopes linear = J.rightCols(2);
    q.tail(2) = linear.colPivHouseholderQr().solve(-r);
    evaluate(q, r, J);
    if (!(r.squaredNorm() < lowest)) continue;
    lowest = r.squaredNorm();
    best = q;
  }
  if (best.size() == 0) return std::nullopt;
  const Parameters q = levenberg_marquardt(best, count, evaluate);
  if (!q.allFinite() || std::abs(q[0]) < kFirst) return std::nullopt;
  return Hyperbola{centre + q[0] * scale, scale, q[1], q[2]};
}

}  // namespace loopbench::methods::manifold
