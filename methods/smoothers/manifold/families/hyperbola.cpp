#include "methods/smoothers/manifold/families/hyperbola.hpp"

#include <Eigen/QR>

#include "methods/smoothers/manifold/families/levenberg_marquardt.hpp"

namespace loopbench::methods::manifold {
namespace {

// Poles tried on each side, in half ranges from the middle. The last one is practically a line.
constexpr double kFirst = 1.0 + 2.0 * kPoleMargin;
constexpr double kLast = 100.0;
constexpr int kHyperbolaStarts = 8;

}  // namespace

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
