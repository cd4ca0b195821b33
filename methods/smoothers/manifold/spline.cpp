#include "methods/smoothers/manifold/spline.hpp"

namespace loopbench::manifold {

NodeSpline::NodeSpline(const Nodes& nodes) : stamps_(nodes.stamps), knots_(nodes.size()) {
  double way = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (i > 0) way += nodes.step(i - 1).norm();
    knots_[i].value << nodes.points[i], way;
    knots_[i].second.setZero();
  }
  // Continuous second derivatives m: h0 m0 + 2 (h0 + h1) m1 + h1 m2 = 6 (slope1 - slope0), with
  // m = 0 at both ends. Thomas' elimination; the matrix is diagonally dominant.
  const std::size_t count = nodes.size();
  std::vector<double> upper(count, 0.0);
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const double h0 = nodes.duration(i - 1);
    const double h1 = nodes.duration(i);
    const Value slope0 = (knots_[i].value - knots_[i - 1].value) / h0;
    const Value slope1 = (knots_[i + 1].value - knots_[i].value) / h1;
    const double pivot = 2.0 * (h0 + h1) - h0 * upper[i - 1];
    upper[i] = h1 / pivot;
    knots_[i].second = (6.0 * (slope1 - slope0) - h0 * knots_[i - 1].second) / pivot;
  }
  for (std::size_t i = count - 1; i-- > 1;) {
    knots_[i].second -= upper[i] * knots_[i + 1].second;
  }
}

Place NodeSpline::at(std::size_t edge, double time) const {
  const Knot& a = knots_[edge];
  const Knot& b = knots_[edge + 1];
  const double h = stamps_[edge + 1] - stamps_[edge];
  const double v = (time - stamps_[edge]) / h;
  const double u = (stamps_[edge + 1] - time) / h;
  const double sixth = h * h / 6.0;
  const Value value = u * a.value + v * b.value + (sixth * (u * u - 1.0) * u) * a.second +
                      (sixth * (v * v - 1.0) * v) * b.second;
  return {value.head<3>(), value[3]};
}

}  // namespace loopbench::manifold
