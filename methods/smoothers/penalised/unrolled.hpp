/// A path of rotations rolled out flat, so that what smooths vectors can smooth attitudes.
#pragma once

#include <algorithm>
#include <vector>

#include "datasets/core/so3.hpp"

namespace loopbench {

/// The great arcs through base rotations B_i, developed into R^3 without slipping or twisting:
///
///     flat_{i+1} = flat_i + Q_i d_i,   Q_{i+1} = Q_i Exp(d_i / 2),   d_i = Log(B_i' B_{i+1}),
///
/// where Q_i carries body vectors along (parallel transport of the bi-invariant metric turns them
/// by half the rotation). A steady turn becomes a straight line, however often it goes round, and
/// where the world's axes point makes no difference. Source: Jupp & Kent 1987 (on the sphere);
/// Kim, Dryden & Le 2021 (on manifolds).
class Unrolled {
 public:
  explicit Unrolled(std::vector<Rotation> base);  ///< one rotation or more; O(n)

  const std::vector<Rotation>& base() const { return base_; }

  /// Where rotation i, near base i, lies: flat_i + Q_i Log(B_i' R).
  Vector3 flattened(std::size_t i, const Rotation& rotation) const {
    return flat_[i] + flat_from_body_[i] * log_so3(base_[i].conjugate() * rotation);
  }

  /// The rotation at a flat point near the base, at fraction u of interval i (0: at base i).
  Rotation rolled(std::size_t i, double u, const Vector3& point) const {
    if (u == 0.0) return turned(base_[i], flat_from_body_[i], point - flat_[i]);
    const Vector3& step = steps_[i];
    return turned(base_[i] * exp_so3(u * step),
                  flat_from_body_[i] * exp_so3(0.5 * u * step),
                  point - flat_[i] - flat_from_body_[i] * (u * step));
  }

 private:
  static Rotation turned(const Rotation& base,
                         const Rotation& flat_from_body,
                         const Vector3& flat_offset) {
    return (base * exp_so3(flat_from_body.conjugate() * flat_offset)).normalized();
  }

  std::vector<Rotation> base_;
  std::vector<Vector3> steps_;  ///< d_i [rad]
  std::vector<Rotation> flat_from_body_;
  std::vector<Vector3> flat_;  ///< [rad]
};

inline Unrolled::Unrolled(std::vector<Rotation> base) : base_(std::move(base)) {
  flat_.push_back(Vector3::Zero());
  flat_from_body_.push_back(Rotation::Identity());
  for (std::size_t i = 0; i + 1 < base_.size(); ++i) {
    steps_.push_back(log_so3(base_[i].conjugate() * base_[i + 1]));
    flat_.push_back(flat_[i] + flat_from_body_[i] * steps_[i]);
    flat_from_body_.push_back((flat_from_body_[i] * exp_so3(0.5 * steps_[i])).normalized());
  }
}

/// A smoothing of rotations found by `smoothed(fit, ...)`: `fit` belongs to `path`.
template <class Fit>
struct SmoothedRotations {
  Unrolled path;
  Fit fit;
  int iterations;
  bool settled;
};

/// Flattens the rotations about a base, lets `fit` smooth the points (it returns a struct with
/// `values`, one a rotation), rolls them up as the next base, and so on until the base stands
/// still: there the fit is that of the manifold, its penalty taken along its own path. Linear
/// convergence, faster the smaller the noise; `settled` is false when after 30 rounds a rotation
/// still moves by more than `still` [rad].
template <class FitPoints>
auto smoothed_rotations(const std::vector<Rotation>& rotations,
                        FitPoints fit_points,
                        double still = 1e-11)
    -> SmoothedRotations<decltype(fit_points(std::vector<Vector3>{}))> {
  constexpr int kMost = 30;
  Unrolled path(rotations);
  for (int round = 1;; ++round) {
    std::vector<Vector3> points;
    points.reserve(rotations.size());
    for (std::size_t i = 0; i < rotations.size(); ++i) {
      points.push_back(path.flattened(i, rotations[i]));
    }
    auto fit = fit_points(points);
    std::vector<Rotation> next;
    next.reserve(rotations.size());
    double change = 0.0;
    for (std::size_t i = 0; i < rotations.size(); ++i) {
      next.push_back(path.rolled(i, 0.0, fit.values[i]));
      change = std::max(change, angle_between(path.base()[i], next[i]));
    }
    const bool settled = change <= still;
    if (settled || round == kMost) return {std::move(path), std::move(fit), round, settled};
    path = Unrolled(std::move(next));
  }
}

}  // namespace loopbench
