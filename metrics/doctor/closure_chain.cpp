#include "metrics/doctor/closure_chain.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace loopbench::metrics {

Chain chain_of(const Problem& problem) {
  const std::size_t size = problem.keyframes.size();
  Chain out{std::vector<Pose>(size),
            std::vector<double>(size, 0.0),
            std::vector<Matrix6>(size, Matrix6::Zero())};
  for (std::size_t i = 0; i + 1 < size && i < problem.odometry.size(); ++i) {
    const Edge& step = problem.odometry[i];
    out.poses[i + 1] = normalized(out.poses[i] * step.from_from_to);
    out.lengths[i + 1] = out.lengths[i] + step.from_from_to.translation.norm();
    const Matrix6 to_first = adjoint(out.poses[i + 1]);
    out.covariances[i + 1] =
        out.covariances[i] + to_first * step.information.inverse() * to_first.transpose();
  }
  return out;
}

double gap_of(const Edge& closure, const Chain& chain) {
  const Pose gap = closure.from_from_to.inverse() * chain.between(closure.from, closure.to);
  return gap.translation.norm();
}

std::vector<const Edge*> sorted_by_end(const std::vector<Edge>& closures) {
  std::vector<const Edge*> out;
  for (const Edge& edge : closures) out.push_back(&edge);
  std::ranges::stable_sort(out, {}, [](const Edge* e) { return std::max(e->from, e->to); });
  return out;
}

}  // namespace loopbench::metrics
