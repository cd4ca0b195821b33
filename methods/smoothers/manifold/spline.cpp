#include "methods/smoothers/manifold/spline.hpp"

namespace loopbench::methods::manifold {

NodeSpline::NodeSpline(const Nodes& nodes, Straight) : stamps_(nodes.stamps), knots_(nodes.size()) {
  double path_length = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (i > 0) path_length += nodes.step(i - 1).norm();
    knots_[i].value << nodes.points[i], path_length;
    knots_[i].before.setZero();
    knots_[i].after.setZero();
  }
}

NodeSpline::NodeSpline(const Nodes& nodes) : NodeSpline(nodes, std::span<const Clamp>{}) {}

NodeSpline::NodeSpline(const Nodes& nodes, std::span<const Clamp> clamps)
    : NodeSpline(nodes, Straight{}) {
  std::size_t first = 0;
  const Clamp* start = nullptr;
  for (const Clamp& clamp : clamps) {
    if (clamp.node > first) solve_second_derivatives(first, clamp.node, start, &clamp);
    first = clamp.node;
    start = &clamp;
  }
  if (first + 1 < nodes.size()) solve_second_derivatives(first, nodes.size() - 1, start, nullptr);
}

NodeSpline NodeSpline::polyline(const Nodes& nodes) { return NodeSpline(nodes, Straight{}); }

NodeSpline NodeSpline::of_order(const Nodes& nodes, std::size_t order) {
  NodeSpline out(nodes, Straight{});
  std::vector<Value> values;
  for (const Knot& knot : out.knots_) values.push_back(knot.value);
  out.b_spline_ = BSpline::through(out.stamps_, values, order);
  return out;
}

// Solves for continuous second derivatives m: h0 m0 + 2 (h0 + h1) m1 + h1 m2 = 6 (slope1 - slope0);
// at the ends m = 0, or 2 h m0 + h m1 = 6 (slope - velocity). Thomas algorithm; the matrix is
// diagonally dominant.
void NodeSpline::solve_second_derivatives(std::size_t first,
                                          std::size_t last,
                                          const Clamp* start,
                                          const Clamp* end) {
  const auto duration = [&](std::size_t i) { return stamps_[i + 1] - stamps_[i]; };
  const auto slope = [&](std::size_t i) -> Value {
    return (knots_[i + 1].value - knots_[i].value) / duration(i);
  };
  const auto velocity = [](const Clamp& clamp) {
    Value out;
    out << clamp.velocity, clamp.velocity.norm();
    return out;
  };
  std::vector<double> upper(last - first + 1, 0.0);
  std::vector<Value> second(last - first + 1, Value::Zero());
  if (start != nullptr) {
    upper[0] = 0.5;
    second[0] = 6.0 * (slope(first) - velocity(*start)) / (2.0 * duration(first));
  }
  for (std::size_t i = first + 1; i < last; ++i) {
    const std::size_t k = i - first;
    const double h0 = duration(i - 1);
    const double h1 = duration(i);
    const double pivot = 2.0 * (h0 + h1) - h0 * upper[k - 1];
    upper[k] = h1 / pivot;
    second[k] = (6.0 * (slope(i) - slope(i - 1)) - h0 * second[k - 1]) / pivot;
  }
  if (end != nullptr) {
    const double h = duration(last - 1);
    const Value right = 6.0 * (velocity(*end) - slope(last - 1));
    second.back() =
        (right - h * second[second.size() - 2]) / (2.0 * h - h * upper[upper.size() - 2]);
  }
  for (std::size_t k = second.size() - 1; k-- > 0;) second[k] -= upper[k] * second[k + 1];
  for (std::size_t i = first; i <= last; ++i) {
    if (i > first) knots_[i].before = second[i - first];
    if (i < last) knots_[i].after = second[i - first];
  }
}

SplinePoint NodeSpline::at(std::size_t edge, double time) const {
  if (b_spline_) {
    const Value value = b_spline_->at(time);
    return {value.head<3>(), value[3], time};
  }
  const Knot& a = knots_[edge];
  const Knot& b = knots_[edge + 1];
  const double h = stamps_[edge + 1] - stamps_[edge];
  const double v = (time - stamps_[edge]) / h;
  const double u = (stamps_[edge + 1] - time) / h;
  const double sixth = h * h / 6.0;
  const Value value = u * a.value + v * b.value + (sixth * (u * u - 1.0) * u) * a.after +
                      (sixth * (v * v - 1.0) * v) * b.before;
  return {value.head<3>(), value[3], time};
}

SplinePointJet NodeSpline::at(std::size_t edge, const Jet<double>& time) const {
  Jet<Value> out;
  if (b_spline_) {
    out = b_spline_->at(time);
  } else {
    const Knot& a = knots_[edge];
    const Knot& b = knots_[edge + 1];
    const double h = stamps_[edge + 1] - stamps_[edge];
    const Jet<double> v = (time - stamps_[edge]) / h;
    const Jet<double> u = (stamps_[edge + 1] - time) / h;
    const double sixth = h * h / 6.0;
    out = u * a.value + v * b.value + (sixth * ((u * u - 1.0) * u)) * a.after +
          (sixth * ((v * v - 1.0) * v)) * b.before;
  }
  return {{out.value.head<3>(), out.first.head<3>(), out.second.head<3>()},
          {out.value[3], out.first[3], out.second[3]},
          time};
}

}  // namespace loopbench::methods::manifold
