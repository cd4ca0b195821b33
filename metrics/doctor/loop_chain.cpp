#include "metrics/doctor/loop_chain.hpp"

#include <algorithm>

#include "metrics/doctor/sampling.hpp"

namespace loopbench::metrics {
namespace {

LoopPath path_over(const Edge& edge, const Edge* over, const Chain& chain) {
  LoopPath out{&edge, over, edge.information.inverse()};
  if (over == nullptr) {
    out.covariance += chain.covariance(edge.from, edge.to);
    return out;
  }
  const Pose last = chain.between(over->to, edge.to).pose;
  const Matrix6 to_end = adjoint(last.inverse()),
                over_to_end = adjoint((over->from_from_to * last).inverse());
  out.covariance += chain.covariance(over->to, edge.to) +
                    to_end * over->information.inverse() * to_end.transpose() +
                    over_to_end * chain.covariance(edge.from, over->from) * over_to_end.transpose();
  return out;
}

}  // namespace

Chain chain_of(const Problem& problem) {
  std::vector<Matrix6> stated;
  std::vector<double> of_translation, of_rotation;
  for (const Edge& step : problem.odometry) {
    stated.push_back(step.information.inverse());
    of_translation.push_back(stated.back().diagonal().head<3>().minCoeff());
    of_rotation.push_back(stated.back().diagonal().tail<3>().minCoeff());
  }
  const double translation = median_value(of_translation), rotation = median_value(of_rotation);
  Chain out{{ScaledPose{}}, {0.0}, {0.0}, {Matrix6::Zero()}};
  for (std::size_t i = 0; i < stated.size(); ++i) {
    const Edge& step = problem.odometry[i];
    out.has_scale |= step.scale != 1.0;
    out.poses.push_back(normalized(out.poses.back() * ScaledPose{step.from_from_to, step.scale}));
    out.distances.push_back(out.distances.back() + step.from_from_to.translation.norm());
    out.steps.push_back(out.steps.back() +
                        std::max(of_translation[i] / translation, of_rotation[i] / rotation));
    const ScaledPose& end = out.poses.back();
    const Matrix6 to_first = adjoint(end.pose) * Chain::in_scale(end.scale);
    out.covariances.push_back(out.covariances.back() + to_first * stated[i] * to_first.transpose());
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
  constexpr std::size_t kCompared = 200;  // bounds the cost
  std::vector<const Edge*> sorted;
  for (const Edge& edge : closures) sorted.push_back(&edge);
  std::ranges::stable_sort(sorted, {}, [](const Edge* e) { return std::pair(e->to, e->from); });
  std::vector<LoopPaths> out;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const Edge& edge = *sorted[i];
    std::vector<std::pair<double, const Edge*>> nearest;  // with the odometry that leads to them
    double most = chain.count(edge.from, edge.to);
    /// Whether closures that are listed further away can be nearer.
    const auto compare = [&](const Edge& other) {
      const double to_end = chain.count(edge.to, other.to);
      const double all = to_end + chain.count(edge.from, other.from);
      // A closure that is listed twice agrees with itself.
      if (all < most && (other.from != edge.from || other.to != edge.to)) {
        nearest.emplace_back(all, &other);
        std::ranges::stable_sort(nearest, {}, &std::pair<double, const Edge*>::first);
        if (nearest.size() > kFewestLoops) nearest.pop_back();
        if (nearest.size() == kFewestLoops) most = nearest.back().first;
      }
      return to_end < most;
    };
    const std::size_t end = std::min(sorted.size(), i + kCompared + 1);
    for (std::size_t j = i + 1; j < end && compare(*sorted[j]); ++j) {
    }
    for (std::size_t j = i; j > i - std::min(i, kCompared) && compare(*sorted[j - 1]); --j) {
    }
    out.push_back({path_over(edge, nullptr, chain), {}});
    for (const auto& [count, other] : nearest)
      out.back().over_closures.push_back(path_over(edge, other, chain));
  }
  return out;
}

}  // namespace loopbench::metrics
