#include "metrics/doctor/loop_chain.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

#include "datasets/core/factorisations.hpp"
#include "metrics/doctor/sampling.hpp"

namespace loopbench::metrics {
namespace {

/// Multiplies translations of twists.
Matrix6 in_scale(double scale) {
  Matrix6 out = Matrix6::Identity();
  out.diagonal().head<3>().setConstant(scale);
  return out;
}

LoopPath path_over(const Edge& edge, const Edge* over, const Chain& chain) {
  LoopPath out{&edge, over, inverse_of(edge.information)};
  if (over == nullptr) {
    out.covariance += chain.covariance(edge.from, edge.to);
    return out;
  }
  const Pose last = chain.between(over->to, edge.to).pose;
  const Matrix6 to_end = adjoint(last.inverse()),
                over_to_end = adjoint((over->from_from_to * last).inverse());
  out.covariance += chain.covariance(over->to, edge.to) +
                    to_end * inverse_of(over->information) * to_end.transpose() +
                    over_to_end * chain.covariance(edge.from, over->from) * over_to_end.transpose();
  return out;
}

}  // namespace

Matrix6 Chain::covariance(std::size_t i, std::size_t j) const {
  const Matrix6 to_end = in_scale(1.0 / poses[j].scale) * adjoint(poses[j].pose.inverse());
  const Matrix6 of_steps = covariances[std::max(i, j)] - covariances[std::min(i, j)];
  return to_end * of_steps * to_end.transpose();
}

Chain chain_of(const Problem& problem) {
  Chain out{{ScaledPose{}}, {0.0}, {Matrix6::Zero()}};
  for (const Edge& step : problem.odometry) {
    out.has_scale |= step.scale != 1.0;
    out.poses.push_back(normalized(out.poses.back() * methods::measured(step)));
    out.distances.push_back(out.distances.back() + step.from_from_to.translation.norm());
    const ScaledPose& end = out.poses.back();
    const Matrix6 to_first = adjoint(end.pose) * in_scale(end.scale);
    out.covariances.push_back(out.covariances.back() +
                              to_first * inverse_of(step.information) * to_first.transpose());
  }
  for (const Edge& closure : problem.closures) out.has_scale |= closure.scale != 1.0;
  return out;
}

Twist LoopPath::residual(const Chain& chain, const PoseChange& change) const {
  const ScaledPose around = over == nullptr
                                ? chain.between(closure->from, closure->to)
                                : chain.between(closure->from, over->from) *
                                      ScaledPose{change(over->from_from_to), over->scale} *
                                      chain.between(over->to, closure->to);
  return log_se3(change(closure->from_from_to).inverse() * around.pose);
}

double LoopPath::chi_squared(const Chain& chain, const PoseChange& change) const {
  const Eigen::Index rows = chain.has_scale && over == nullptr ? 3 : 6;
  const Eigen::VectorXd values = residual(chain, change).tail(rows);
  const Eigen::MatrixXd stated = covariance.bottomRightCorner(rows, rows);
  return values.dot(stated.ldlt().solve(values)) / static_cast<double>(rows);
}

std::vector<LoopPaths> loop_paths(const std::vector<Edge>& closures, const Chain& chain) {
  std::vector<const Edge*> sorted;
  for (const Edge& edge : closures) sorted.push_back(&edge);
  std::ranges::stable_sort(sorted, {}, [](const Edge* e) { return std::pair(e->to, e->from); });
  std::vector<LoopPaths> out;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const Edge& edge = *sorted[i];
    const double most = chain.variance(edge.from, edge.to);
    std::vector<std::pair<double, const Edge*>> nearer;  // with the variance of the odometry
    const std::size_t end = std::min(sorted.size(), i + kMostPoses + 1);
    for (std::size_t j = i - std::min(i, kMostPoses); j < end; ++j) {
      const Edge& other = *sorted[j];
      const double all = chain.variance(edge.from, other.from) + chain.variance(edge.to, other.to);
      // A closure that is listed twice agrees with itself.
      const bool is_same = other.from == edge.from && other.to == edge.to;
      if (all < most && !is_same) nearer.emplace_back(all, &other);
    }
    const std::size_t count = std::min(kFewestLoops, nearer.size());
    std::ranges::partial_sort(nearer, nearer.begin() + static_cast<std::ptrdiff_t>(count));
    out.push_back({path_over(edge, nullptr, chain), {}});
    for (std::size_t j = 0; j < count; ++j)
      out.back().over_closures.push_back(path_over(edge, nearer[j].second, chain));
  }
  return out;
}

MedianFit::MedianFit(const std::vector<const LoopPaths*>& loops,
                     const Chain& chain,
                     const PoseChange& change) {
  std::vector<double> direct, around;
  for (const LoopPaths* loop : loops) {
    direct.push_back(loop->odometry.chi_squared(chain, change));
    if (!loop->over_closures.empty())
      around.push_back(loop->over_closures.front().chi_squared(chain, change));
  }
  if (around.size() < loops.size() / 2) around = direct;
  odometry = kFileRounding + median_value(std::move(direct));
  over_closures = kFileRounding + median_value(std::move(around));
}

}  // namespace loopbench::metrics
