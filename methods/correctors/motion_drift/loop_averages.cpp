#include "methods/correctors/motion_drift/loop_averages.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace loopbench::methods {
namespace {

double lower_median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

LoopAverages::LoopAverages(const Problem& problem,
                           const std::vector<EdgeMotion>& motions,
                           const Eigen::VectorXd& gap)
    : problem_(problem), motions_(motions) {
  for (const Component component : {Component::translation, Component::rotation}) {
    means_[index(component)] = means_of(component, gap);
  }
}

LoopAverages::Means LoopAverages::means_of(Component component, const Eigen::VectorXd& gap) const {
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

double LoopAverages::motion(Component component, Regressor regressor, bool squared) const {
  return mean_along_loops(
      component, squared, [&](std::size_t i) { return regressor_value(regressor, motions_[i]); });
}

double LoopAverages::stated_odometry(Component component) const {
  const auto first = static_cast<Eigen::Index>(3 * index(component));
  return mean_along_loops(component, false, [&](std::size_t i) {
    return problem_.odometry[i].information.inverse().diagonal().segment<3>(first).mean();
  });
}

}  // namespace loopbench::methods
