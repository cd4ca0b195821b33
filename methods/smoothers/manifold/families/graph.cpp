#include "methods/smoothers/manifold/families/graph.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <limits>
#include <numbers>

#include "methods/smoothers/manifold/families/fitting.hpp"

namespace loopbench::methods::manifold {
namespace {

constexpr int kSineStarts = 12;
constexpr double kLongest = 8.0;   // longest initial wavelength, in ranges of x
constexpr double kShortest = 4.0;  // shortest wavelength, in point spacings; below it is ambiguous
constexpr double kTallest = 2.0;   // largest amplitude, in ranges of y

// Poles tried on each side, in half ranges from the middle. The last one is practically a line.
constexpr double kFirst = 1.0 + 2.0 * kPoleMargin;
constexpr double kLast = 100.0;
constexpr int kHyperbolaStarts = 8;

/// Whether the denominator of Rational has a root near the points: u runs from -1 to 1 there.
bool has_pole(double q1, double q2) {
  const double discriminant = 0.25 * q1 * q1 - q2;
  if (discriminant < 0.0) return false;
  const double root = std::sqrt(discriminant);
  return std::abs(-0.5 * q1 - root) <= kFirst || std::abs(-0.5 * q1 + root) <= kFirst;
}

/// Fits three parameters, of which all but the first are linear: Levenberg-Marquardt from the best
/// of the values first(0) .. first(starts - 1), each with its linear least-squares solution.
/// `evaluate` as in levenberg_marquardt(). Empty if no sum of squares is finite.
template <class First, class Evaluate>
Parameters fit_from_grid(int starts, First first, Eigen::Index count, Evaluate evaluate) {
  Parameters best;
  double lowest = std::numeric_limits<double>::infinity();
  for (int start = 0; start < starts; ++start) {
    Parameters q = Parameters::Zero(3);
    q[0] = first(start);
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
  return best.size() == 0 ? best : levenberg_marquardt(best, count, evaluate);
}

}  // namespace

Polynomial fit_polynomial(std::span<const Vector2> points, int degree) {
  const auto count = static_cast<Eigen::Index>(points.size());
  const auto [left, right] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x() < b.x(); });
  Polynomial out;
  out.centre = 0.5 * (left->x() + right->x());
  out.scale = 0.5 * (right->x() - left->x());

  const Eigen::Index terms = std::min<Eigen::Index>(degree + 1, count);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxNodes, 4> powers(count, terms);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxNodes, 1> y(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vector2& point = points[static_cast<std::size_t>(i)];
    y[i] = point.y();
    powers(i, 0) = 1.0;
    for (Eigen::Index k = 1; k < terms; ++k) {
      powers(i, k) = powers(i, k - 1) * (point.x() - out.centre) / out.scale;
    }
  }
  out.coefficients.head(terms) = powers.householderQr().solve(y);
  return out;
}

std::optional<Sine> fit_sine(std::span<const Vector2> points) {
  const auto count = static_cast<Eigen::Index>(points.size());
  if (count < 4 || count > kMaxNodes) return std::nullopt;
  const Extent extent(points);
  const Vector2 size = extent.size();
  if (!(size.x() > 0.0)) return std::nullopt;
  const double centre = extent.centre().x();
  const double spacing = size.x() / static_cast<double>(count - 1);
  const double slowest = 2.0 * std::numbers::pi / (kLongest * size.x());
  const double fastest = 2.0 * std::numbers::pi / (kShortest * spacing);
  // The parameters are b, a cos c and a sin c.
  const auto evaluate = [&](const Parameters& q, FamilyResiduals& r, Slopes& J) {
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      const double x = points[static_cast<std::size_t>(i)].x() - centre;
      const double s = std::sin(q[0] * x);
      const double c = std::cos(q[0] * x);
      r[i] = q[1] * s + q[2] * c - points[static_cast<std::size_t>(i)].y();
      J(i, 0) = x * (q[1] * c - q[2] * s);
      J(i, 1) = s;
      J(i, 2) = c;
    }
  };
  const auto rate = [&](int start) {
    return slowest * std::pow(fastest / slowest, start / (kSineStarts - 1.0));
  };
  const Parameters q = fit_from_grid(kSineStarts, rate, count, evaluate);
  if (q.size() == 0 || !q.allFinite()) return std::nullopt;
  // A negative rate is the same curve with reversed sign.
  const double sign = q[0] < 0.0 ? -1.0 : 1.0;
  Sine out;
  out.rate = std::abs(q[0]);
  out.amplitude = std::hypot(q[1], q[2]);
  out.phase = std::atan2(q[2], sign * q[1]) - out.rate * centre;
  const bool alias = out.rate > fastest * (1.0 + 1e-9) || out.amplitude > kTallest * size.y();
  if (!(out.rate > 0.0) || alias) return std::nullopt;
  return out;
}

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
  const auto pole = [](int start) {
    const double distance =
        kFirst * std::pow(kLast / kFirst, (start / 2) / (kHyperbolaStarts - 1.0));
    return start % 2 == 1 ? -distance : distance;
  };
  const Parameters q = fit_from_grid(2 * kHyperbolaStarts, pole, count, evaluate);
  if (q.size() == 0 || !q.allFinite() || std::abs(q[0]) < kFirst) return std::nullopt;
  return Hyperbola{centre + q[0] * scale, scale, q[1], q[2]};
}

}  // namespace loopbench::methods::manifold
