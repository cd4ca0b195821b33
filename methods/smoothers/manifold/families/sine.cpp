#include <Eigen/QR>
#include <numbers>

#include "methods/smoothers/manifold/families/fitting.hpp"
#include "methods/smoothers/manifold/families/graph.hpp"

namespace loopbench::methods::manifold {
namespace {

constexpr int kSineStarts = 12;
constexpr double kLongest = 8.0;   // longest initial wavelength, in ranges of x
constexpr double kShortest = 4.0;  // shortest wavelength, in point spacings; below it is ambiguous
constexpr double kTallest = 2.0;   // largest amplitude, in ranges of y

// The parameters are b, a cos c, a sin c; all but the first are linear.
void evaluate(std::span<const Vector2> points,
              double centre,
              const Parameters& q,
              FamilyResiduals& r,
              Slopes& J) {
  for (Eigen::Index i = 0; i < r.size(); ++i) {
    const double x = points[static_cast<std::size_t>(i)].x() - centre;
    const double s = std::sin(q[0] * x);
    const double c = std::cos(q[0] * x);
    r[i] = q[1] * s + q[2] * c - points[static_cast<std::size_t>(i)].y();
    J(i, 0) = x * (q[1] * c - q[2] * s);
    J(i, 1) = s;
    J(i, 2) = c;
  }
}

}  // namespace

std::optional<Sine> fit_sine(std::span<const Vector2> points) {
  constexpr Eigen::Index unknowns = 3;
  const auto count = static_cast<Eigen::Index>(points.size());
  if (count < unknowns + 1 || count > kMaxNodes) return std::nullopt;
  const Extent extent(points);
  const Vector2 size = extent.size();
  if (!(size.x() > 0.0)) return std::nullopt;
  const double centre = extent.centre().x();
  const double spacing = size.x() / static_cast<double>(count - 1);
  const double slowest = 2.0 * std::numbers::pi / (kLongest * size.x());
  const double fastest = 2.0 * std::numbers::pi / (kShortest * spacing);

  const auto cost = [&](const Parameters& q) {
    FamilyResiduals r(count);
    Slopes J(count, unknowns);
    evaluate(points, centre, q, r, J);
    return r.squaredNorm();
  };
  std::optional<Parameters> best;
  for (int start = 0; start < kSineStarts; ++start) {
    Parameters q = Parameters::Zero(unknowns);
    q[0] = slowest * std::pow(fastest / slowest, start / (kSineStarts - 1.0));
    FamilyResiduals r(count);
    Slopes J(count, unknowns);
    evaluate(points, centre, q, r, J);  // the linear parameters are zero, so r = -y
    const Slopes linear = J.rightCols(unknowns - 1);
    q.tail(unknowns - 1) = linear.colPivHouseholderQr().solve(-r);
    if (!best || cost(q) < cost(*best)) best = q;
  }
  const Parameters q = levenberg_marquardt(
      *best, count, [&](const auto& p, auto& r, auto& J) { evaluate(points, centre, p, r, J); });
  // A negative rate is the same curve with reversed sign.
  const double sign = q[0] < 0.0 ? -1.0 : 1.0;
  Sine out;
  out.rate = std::abs(q[0]);
  out.amplitude = std::hypot(q[1], q[2]);
  out.phase = std::atan2(q[2], sign * q[1]) - out.rate * centre;
  const bool alias = out.rate > fastest * (1.0 + 1e-9) || out.amplitude > kTallest * size.y();
  if (!q.allFinite() || !(out.rate > 0.0) || alias) return std::nullopt;
  return out;
}

}  // namespace loopbench::methods::manifold
