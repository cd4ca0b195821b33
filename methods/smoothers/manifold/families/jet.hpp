/// A value with its first two time derivatives, for joints and curvature without finite
/// differences.
#pragma once

#include <cmath>
#include <type_traits>

#include "datasets/core/so3.hpp"

namespace loopbench::methods::manifold {

template <class T>
struct Jet {
  T value;
  T first;   ///< [per second]
  T second;  ///< [per second squared]
};

using MotionJet = Jet<Vector3>;  ///< position, velocity, acceleration

/// Result type of a point at a time of type T: Vector3 for a double, MotionJet for a Jet.
template <class T>
using VectorOf = std::conditional_t<std::is_same_v<T, double>, Vector3, MotionJet>;

/// The time as a Jet.
inline Jet<double> time_jet(double time) { return {time, 1.0, 0.0}; }

inline double value_of(double x) { return x; }
inline double value_of(const Jet<double>& x) { return x.value; }

template <class T>
Jet<T> operator+(const Jet<T>& a, const Jet<T>& b) {
  return {a.value + b.value, a.first + b.first, a.second + b.second};
}
template <class T>
Jet<T> operator-(const Jet<T>& a, const Jet<T>& b) {
  return {a.value - b.value, a.first - b.first, a.second - b.second};
}
template <class T>
Jet<T> operator+(const Jet<T>& a, const T& constant) {
  return {a.value + constant, a.first, a.second};
}
template <class T>
Jet<T> operator+(const T& constant, const Jet<T>& a) {
  return a + constant;
}
template <class T>
Jet<T> operator-(const Jet<T>& a, const T& constant) {
  return {a.value - constant, a.first, a.second};
}
inline Jet<double> operator-(double constant, const Jet<double>& a) {
  return {constant - a.value, -a.first, -a.second};
}

template <class T>
Jet<T> operator*(const Jet<double>& s, const Jet<T>& a) {
  return {s.value * a.value,
          s.first * a.value + s.value * a.first,
          s.second * a.value + 2.0 * s.first * a.first + s.value * a.second};
}
template <class T>
Jet<T> operator*(double s, const Jet<T>& a) {
  return {s * a.value, s * a.first, s * a.second};
}
inline Jet<double> operator*(const Jet<double>& a, double s) { return s * a; }
inline Jet<double> operator/(const Jet<double>& a, double s) { return (1.0 / s) * a; }

/// A scalar Jet times a fixed direction.
template <class Derived>
Jet<typename Derived::PlainObject> operator*(const Jet<double>& s,
                                             const Eigen::MatrixBase<Derived>& fixed) {
  return {s.value * fixed, s.first * fixed, s.second * fixed};
}

/// Chain rule: g(x(t)) from g and its first two derivatives at x.
inline Jet<double> chained(const Jet<double>& x, double g, double slope, double curvature) {
  return {g, slope * x.first, curvature * x.first * x.first + slope * x.second};
}
inline Jet<double> operator/(double s, const Jet<double>& a) {
  const double inverse = 1.0 / a.value;
  const double slope = -s * inverse * inverse;
  return chained(a, s * inverse, slope, -2.0 * slope * inverse);
}
inline Jet<double> sin(const Jet<double>& x) {
  return chained(x, std::sin(x.value), std::cos(x.value), -std::sin(x.value));
}
inline Jet<double> cos(const Jet<double>& x) {
  return chained(x, std::cos(x.value), -std::sin(x.value), -std::cos(x.value));
}

/// Component along a fixed direction.
inline double along(const Vector3& direction, const Vector3& v) { return direction.dot(v); }
inline Jet<double> along(const Vector3& direction, const MotionJet& v) {
  return {direction.dot(v.value), direction.dot(v.first), direction.dot(v.second)};
}

/// Component of S'' perpendicular to S' over |S'|^2: points to the centre of curvature, length
/// kappa [1/m].
inline Vector3 curvature_vector(const Vector3& first, const Vector3& second) {
  return (second - first.dot(second) / first.squaredNorm() * first) / first.squaredNorm();
}

}  // namespace loopbench::methods::manifold
