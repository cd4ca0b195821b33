/// Interpolating cubic splines in time, given by their second derivatives at the stamps.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "datasets/core/banded.hpp"

namespace loopbench {

/// Returns the second derivatives at the stamps of the twice differentiable cubic spline through
/// `values`. They are zero at both ends (natural spline), except at an end with a given velocity.
/// Requires at least two strictly increasing stamps and as many values. O(n).
/// Source: de Boor, A Practical Guide to Splines, ch. IV.
template <class Value>
std::vector<Value> cubic_second_derivatives(std::span<const double> stamps,
                                            std::span<const Value> values,
                                            const Value* velocity_at_start = nullptr,
                                            const Value* velocity_at_end = nullptr) {
  const std::size_t last = values.size() - 1;
  const auto duration = [&](std::size_t i) { return stamps[i + 1] - stamps[i]; };
  const auto slope = [&](std::size_t i) -> Value {
    return (values[i + 1] - values[i]) / duration(i);
  };
  BandedSystem<double, Value> system(values.size(), 1);
  system.at(0, 0) = 1.0;
  system.at(last, last) = 1.0;
  for (std::size_t i = 1; i < last; ++i) {
    const double before = duration(i - 1);
    const double after = duration(i);
    system.at(i, i - 1) = before;
    system.at(i, i) = 2.0 * (before + after);
    system.at(i, i + 1) = after;
    system.right(i) = 6.0 * (slope(i) - slope(i - 1));
  }
  if (velocity_at_start != nullptr) {
    system.at(0, 0) = 2.0 * duration(0);
    system.at(0, 1) = duration(0);
    system.right(0) = 6.0 * (slope(0) - *velocity_at_start);
  }
  if (velocity_at_end != nullptr) {
    system.at(last, last) = 2.0 * duration(last - 1);
    system.at(last, last - 1) = duration(last - 1);
    system.right(last) = 6.0 * (*velocity_at_end - slope(last - 1));
  }
  return system.solve();
}

/// A knot of a cubic spline.
template <class Value>
struct CubicKnot {
  double stamp;
  const Value& value;
  const Value& second_derivative;
};

/// Returns the value of the spline at `time` between two knots. `Time` is double, or a type with
/// the same operations that carries derivatives; `Result` is the type of Time times Value.
template <class Result, class Value, class Time>
Result cubic_between(const CubicKnot<Value>& a, const CubicKnot<Value>& b, const Time& time) {
  const double h = b.stamp - a.stamp;
  const Time v = (time - a.stamp) / h;
  const Time u = (b.stamp - time) / h;
  const double sixth = h * h / 6.0;
  return u * a.value + v * b.value + (sixth * ((u * u - 1.0) * u)) * a.second_derivative +
         (sixth * ((v * v - 1.0) * v)) * b.second_derivative;
}

}  // namespace loopbench
