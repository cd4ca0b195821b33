/// Unrolls a path of rotations into R^3, so that methods for vectors can smooth rotations.
#pragma once

#include <algorithm>
#include <vector>

#include "datasets/core/so3.hpp"

namespace loopbench::methods {

/// Development of the great arcs through base rotations B_i into R^3 without slipping or twisting:
///
///     flat_{i+1} = flat_i + Q_i d_i,   Q_{i+1} = Q_i Exp(d_i / 2),   d_i = Log(B_i' B_{i+1}),
///
/// where Q_i is the parallel transport of body vectors (with the bi-invariant metric, half the
/// rotation). A constant angular velocity becomes a straight line for any number of revolutions,
/// and the result does not depend on the world axes. Sources: Jupp & Kent 1987 (sphere); Kim,
/// Dryden & Le 2021 (manifolds).
class UnrolledRotations {
 public:
  explicit UnrolledRotations(std::vector<Rotation> base);  ///< requires at least one rotation; O(n)

  const std::vector<Rotation>& base() const { return base_; }

  /// Unrolled point of rotation i, which is near base i: flat_i + Q_i Log(B_i' R).
  Vector3 unroll(std::size_t i, const Rotation& rotation) const {
    return flat_[i] + flat_from_body_[i] * log_so3(base_[i].conjugate() * rotation);
  }

  /// Rotation of an unrolled point near the base, at fraction u of interval i (0: at base i).
  Rotation roll(std::size_t i, double u, const Vector3& point) const {
    if (u == 0.0) return rotated(base_[i], flat_from_body_[i], point - flat_[i]);
    const Vector3& step = steps_[i];
    return rotated(base_[i] * exp_so3(u * step),
                   flat_from_body_[i] * exp_so3(0.5 * u * step),
                   point - flat_[i] - flat_from_body_[i] * (u * step));
  }

 private:
  static Rotation rotated(const Rotation& base,
                          const Rotation& flat_from_body,
                          const Vector3& flat_offset) {
    return (base * exp_so3(flat_from_body.conjugate() * flat_offset)).normalized();
  }

  std::vector<Rotation> base_;
  std::vector<Vector3> steps_;  ///< d_i [rad]
  std::vector<Rotation> flat_from_body_;
  std::vector<Vector3> flat_;  ///< [rad]
};

inline UnrolledRotations::UnrolledRotations(std::vector<Rotation> base) : base_(std::move(base)) {
  flat_.push_back(Vector3::Zero());
  flat_from_body_.push_back(Rotation::Identity());
  for (std::size_t i = 0; i + 1 < base_.size(); ++i) {
    steps_.push_back(log_so3(base_[i].conjugate() * base_[i + 1]));
    flat_.push_back(flat_[i] + flat_from_body_[i] * steps_[i]);
    flat_from_body_.push_back((flat_from_body_[i] * exp_so3(0.5 * steps_[i])).normalized());
  }
}

/// Result of smoothed_rotations(): `fit` is relative to `path`.
template <class Fit>
struct SmoothedRotations {
  UnrolledRotations path;
  Fit fit;
  int iterations;
  bool converged;
};

/// Unrolls the rotations about a base, smooths the points with `fit_points` (which returns a struct
/// with `values`, one per rotation), and rolls the result back as the next base, until the base
/// converges. At convergence the fit minimises the cost on the manifold with the penalty along its
/// own path. Linear convergence, faster for smaller noise. `converged` is false when a rotation
/// still changes by more than 1e-11 rad after 30 rounds.
template <class FitPoints>
auto smoothed_rotations(const std::vector<Rotation>& rotations, FitPoints fit_points)
    -> SmoothedRotations<decltype(fit_points(std::vector<Vector3>{}))> {
  constexpr int kMaxRounds = 30;
  constexpr double kTolerance = 1e-11;  // [rad]
  UnrolledRotations path(rotations);
  for (int round = 1;; ++round) {
    std::vector<Vector3> points;
    points.reserve(rotations.size());
    for (std::size_t i = 0; i < rotations.size(); ++i) {
      points.push_back(path.unroll(i, rotations[i]));
    }
    auto fit = fit_points(points);
    std::vector<Rotation> next;
    next.reserve(rotations.size());
    double change = 0.0;
    for (std::size_t i = 0; i < rotations.size(); ++i) {
      next.push_back(path.roll(i, 0.0, fit.values[i]));
      change = std::max(change, angle_between(path.base()[i], next[i]));
    }
    const bool converged = change <= kTolerance;
    if (converged || round == kMaxRounds)
      return {std::move(path), std::move(fit), round, converged};
    path = UnrolledRotations(std::move(next));
  }
}

}  // namespace loopbench::methods
