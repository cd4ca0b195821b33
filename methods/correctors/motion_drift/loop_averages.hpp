/// Weighted averages over the loops of a chain, used to scale the prior of the noise model.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>

#include "methods/correctors/motion_drift/model.hpp"

namespace loopbench::methods {

/// Weighted means over the loop closures. Closure k has the weight 1 / (s + g)^2, the inverse
/// variance of a squared gap, where s is its stated variance and g the lower median of the squared
/// gaps. Equal variances give equal weights; a closure whose variance is much larger than the gaps
/// has almost no weight; a closure whose variance is much smaller counts no more than the others.
/// Translation and rotation are weighted separately.
///
/// The motion of a loop is at least the chain's mean motion per second times the loop's duration: a
/// loop closed while the vehicle is at rest does not determine an error per metre or per radian.
class LoopAverages {
 public:
  /// `gap` holds six numbers per closure. O(closures log closures + edges).
  LoopAverages(const Problem& problem,
               const std::vector<EdgeMotion>& motions,
               const Eigen::VectorXd& gap);

  /// Mean squared gap per axis [m^2], [rad^2].
  double gap(Component component) const { return means_[index(component)].gap; }

  /// Mean stated variance of the closures per axis [m^2], [rad^2].
  double stated(Component component) const { return means_[index(component)].stated; }

  /// Mean over the loops of the (optionally squared) motion accumulated along a loop. O(edges +
  /// closures).
  double motion(Component component, Regressor regressor, bool squared) const;

  /// Mean over the loops of the stated odometry variance per axis accumulated along a loop [m^2],
  /// [rad^2]. O(edges + closures).
  double stated_odometry(Component component) const;

 private:
  struct Means {
    double gap = 0.0;
    double stated = 0.0;
    std::vector<double> weights;  ///< one per closure, normalised to a sum of 1
  };
  static std::size_t index(Component component) { return static_cast<std::size_t>(component); }
  Means means_of(Component component, const Eigen::VectorXd& gap) const;
  template <class Of>
  double mean_along_loops(Component component, bool squared, Of of) const;

  const Problem& problem_;
  const std::vector<EdgeMotion>& motions_;
  Means means_[2];
};

inline double lower_median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

inline LoopAverages::LoopAverages(const Problem& problem,
                                  const std::vector<EdgeMotion>& motions,
                                  const Eigen::VectorXd& gap)
    : problem_(problem), motions_(motions) {
  for (const Component component : {Component::translation, Component::rotation}) {
    means_[index(component)] = means_of(component, gap);
  }
}

inline LoopAverages::Means LoopAverages::means_of(Component component,
                                                  const Eigen::VectorXd& gap) const {
  // A planar gap has only x, y and yaw; the other entries are zero.
  const double axes = !problem_.planar ? 3.0 : component == Component::translation ? 2.0 : 1.0;
  const auto first = static_cast<Eigen::Index>(3 * index(component));
  std::vector<double> gaps, stated;
  for (std::size_t k = 0; k < problem_.closures.size(); ++k) {
    const Matrix6 covariance = problem_.closures[k].information.inverse();
    stated.push_back(covariance.diagonal().segment<3>(first).mean());
    gaps.push_back(gap.segment<3>(static_cast<Eigen::Index>(6 * k) + first).squaredNorm() / axes);
  }
  Means out;
  const double typical = lower_median(gaps);
  double sum = 0.0;
  for (const double variance : stated) {
    const double deviation = variance + typical;
    sum += out.weights.emplace_back(1.0 / (deviation * deviation));
  }
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    out.weights[k] /= sum;
    out.gap += out.weights[k] * gaps[k];
    out.stated += out.weights[k] * stated[k];
  }
  return out;
}

template <class Of>
double LoopAverages::mean_along_loops(Component component, bool squared, Of of) const {
  const std::size_t edges = problem_.odometry.size();
  std::vector<double> sum(edges + 1, 0.0);
  for (std::size_t i = 0; i < edges; ++i) sum[i + 1] = sum[i] + of(i);
  const Trajectory& keyframes = problem_.keyframes;
  const double per_second = sum.back() / (keyframes.back().stamp - keyframes.front().stamp);
  double mean = 0.0;
  for (std::size_t k = 0; k < problem_.closures.size(); ++k) {
    const Edge& loop = problem_.closures[k];
    const double seconds = keyframes[loop.to].stamp - keyframes[loop.from].stamp;
    const double along = std::max(sum[loop.to] - sum[loop.from], per_second * seconds);
    mean += means_[index(component)].weights[k] * (squared ? along * along : along);
  }
  return mean;
}

inline double LoopAverages::motion(Component component, Regressor regressor, bool squared) const {
  return mean_along_loops(
      component, squared, [&](std::size_t i) { return regressor_value(regressor, motions_[i]); });
}

inline double LoopAverages::stated_odometry(Component component) const {
  const auto first = static_cast<Eigen::Index>(3 * index(component));
  return mean_along_loops(component, false, [&](std::size_t i) {
    return problem_.odometry[i].information.inverse().diagonal().segment<3>(first).mean();
  });
}

}  // namespace loopbench::methods
