#include "methods/smoothers/manifold/spline.hpp"

#include "datasets/core/cubic.hpp"
#include "methods/smoothers/spline/interpolate.hpp"

namespace loopbench::methods::manifold {

using Value = BSpline::Value;

BSpline BSpline::through(const std::vector<double>& sites,
                         const std::vector<Value>& values,
                         std::size_t order) {
  SplineBasis basis = SplineBasis::for_sites(order, sites);
  std::vector<Value> controls = interpolating_controls(basis, sites, values);
  return {std::move(basis), std::move(controls)};
}

Value BSpline::at(double u) const {
  const std::size_t piece = basis.piece_at(u);
  const auto N = basis.values(piece, u);
  Value out = Value::Zero();
  for (std::size_t j = 0; j < basis.order(); ++j) out += N[j] * controls[piece + j];
  return out;
}

Jet<Value> BSpline::at(const Jet<double>& u) const {
  const std::size_t piece = basis.piece_at(u.value);
  const auto N = basis.values(piece, u);
  Jet<Value> out{Value::Zero(), Value::Zero(), Value::Zero()};
  for (std::size_t j = 0; j < basis.order(); ++j) out = out + N[j] * controls[piece + j];
  return out;
}

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

void NodeSpline::solve_second_derivatives(std::size_t first,
                                          std::size_t last,
                                          const Clamp* start,
                                          const Clamp* end) {
  std::vector<Value> values;
  for (std::size_t i = first; i <= last; ++i) values.push_back(knots_[i].value);
  const auto velocity = [](const Clamp* clamp) -> std::optional<Value> {
    if (clamp == nullptr) return std::nullopt;
    Value out;
    out << clamp->velocity, clamp->velocity.norm();
    return out;
  };
  const std::optional<Value> at_start = velocity(start), at_end = velocity(end);
  const std::vector<Value> second =
      cubic_second_derivatives<Value>(std::span(stamps_).subspan(first, values.size()),
                                      values,
                                      at_start ? &*at_start : nullptr,
                                      at_end ? &*at_end : nullptr);
  for (std::size_t i = first; i <= last; ++i) {
    if (i > first) knots_[i].before = second[i - first];
    if (i < last) knots_[i].after = second[i - first];
  }
}

template <class Result, class Time>
Result NodeSpline::value_at(std::size_t edge, const Time& time) const {
  if (b_spline_) return b_spline_->at(time);
  const Knot& a = knots_[edge];
  const Knot& b = knots_[edge + 1];
  return cubic_between<Result, Value>(
      {stamps_[edge], a.value, a.after}, {stamps_[edge + 1], b.value, b.before}, time);
}

SplinePoint NodeSpline::at(std::size_t edge, double time) const {
  const auto value = value_at<Value>(edge, time);
  return {value.head<3>(), value[3], time};
}

SplinePointJet NodeSpline::at(std::size_t edge, const Jet<double>& time) const {
  const auto out = value_at<Jet<Value>>(edge, time);
  return {{out.value.head<3>(), out.first.head<3>(), out.second.head<3>()},
          {out.value[3], out.first[3], out.second[3]},
          time};
}

}  // namespace loopbench::methods::manifold
