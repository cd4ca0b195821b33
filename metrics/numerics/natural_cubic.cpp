#include "metrics/numerics/natural_cubic.hpp"

#include <stdexcept>

#include "datasets/core/tridiagonal.hpp"

namespace loopbench::metrics {

NaturalCubic::NaturalCubic(std::vector<double> stamps, std::vector<Vector3> points)
    : stamps_(std::move(stamps)), points_(std::move(points)) {
  const std::size_t n = stamps_.size();
  if (n < 2 || points_.size() != n) {
    throw std::invalid_argument("natural cubic: needs at least two stamps and as many points");
  }
  std::vector<TridiagonalRow<double, Vector3>> rows(n, {0.0, 1.0, 0.0, Vector3::Zero()});
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = stamps_[i] - stamps_[i - 1];
    const double after = stamps_[i + 1] - stamps_[i];
    const Vector3 bend =
        (points_[i + 1] - points_[i]) / after - (points_[i] - points_[i - 1]) / before;
    rows[i] = {before, 2.0 * (before + after), after, 6.0 * bend};
  }
  second_derivatives_ = solve_tridiagonal(rows);
}

Vector3 NaturalCubic::at(std::size_t i, double time) const {
  const double h = stamps_[i + 1] - stamps_[i];
  const double u = (time - stamps_[i]) / h;
  const double v = 1.0 - u;
  const double sixth = h * h / 6.0;
  return v * points_[i] + u * points_[i + 1] +
         sixth * ((v * v * v - v) * second_derivatives_[i] +
                  (u * u * u - u) * second_derivatives_[i + 1]);
}

}  // namespace loopbench::metrics
