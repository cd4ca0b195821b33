/// Closures against the odometry between their keyframes.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "methods/correctors/ledger/closure_error.hpp"
#include "methods/solvers/residuals.hpp"

namespace loopbench::methods {

/// Odometry in unbroken runs of keyframes, with sums from the begin of each run.
class OdometryRuns {
 public:
  explicit OdometryRuns(const Problem& problem)
      : run_(problem.keyframes.size(), 0), travelled_(problem.keyframes.size(), 0.0) {
    auto edge = problem.odometry.begin();
    for (std::size_t k = 0; k + 1 < run_.size(); ++k) {
      const bool is_measured = edge != problem.odometry.end() && edge->from == k;
      run_[k + 1] = run_[k] + (is_measured ? 0 : 1);
      travelled_[k + 1] = travelled_[k];
      if (is_measured) travelled_[k + 1] += (edge++)->from_from_to.translation.norm();
    }
  }

  /// Index of the run of a keyframe.
  std::size_t run(std::size_t keyframe) const { return run_[keyframe]; }

  /// Distance travelled between the keyframes of an edge [m]; unset: they are in different runs.
  std::optional<double> length(const Edge& edge) const {
    if (run_[edge.from] != run_[edge.to]) return std::nullopt;
    return travelled_[edge.to] - travelled_[edge.from];
  }

 private:
  std::vector<std::size_t> run_;
  std::vector<double> travelled_;
};

/// Poses of all keyframes by the odometry of their runs, each with its centroid at the origin:
/// adjoints grow with the distance from it and lose precision.
template <class G>
std::vector<typename G::Element> integrated_runs(const Problem& problem, const OdometryRuns& runs) {
  std::vector<ScaledPose> poses(problem.keyframes.size());
  std::vector<Vector3> centre(runs.run(poses.size() - 1) + 1, Vector3::Zero());
  std::vector<double> count(centre.size(), 0.0);
  for (const Edge& edge : problem.odometry) {
    poses[edge.to] = normalized(poses[edge.from] * measured(edge));
  }
  for (std::size_t k = 0; k < poses.size(); ++k) {
    centre[runs.run(k)] += poses[k].pose.translation;
    count[runs.run(k)] += 1.0;
  }
  std::vector<typename G::Element> out;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    poses[k].pose.translation -= centre[runs.run(k)] / count[runs.run(k)];
    out.push_back(G::from(poses[k]));
  }
  return out;
}

/// One per closure; unset: no odometry joins its keyframes. The covariance of a sum of steps is a
/// difference of running sums. O(keyframes + closures).
template <class G>
std::vector<std::optional<ClosureError>> odometry_errors(const Problem& problem,
                                                         const OdometryRuns& runs) {
  using Square = typename G::Square;
  const std::vector<typename G::Element> poses = integrated_runs<G>(problem, runs);
  std::vector<Square> sum(poses.size(), Square::Zero());
  auto edge = problem.odometry.begin();
  for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
    sum[k + 1] = sum[k];
    if (edge == problem.odometry.end() || edge->from != k) continue;
    const Square J = G::adjoint(poses[k + 1]);
    const Square information = G::information(*edge++, 1.0);
    sum[k + 1] += J * inverse_of(information) * J.transpose();
  }
  std::vector<std::optional<ClosureError>> out;
  for (const Edge& closure : problem.closures) {
    if (runs.run(closure.from) != runs.run(closure.to)) {
      out.emplace_back();
      continue;
    }
    const EdgeResidual<G> at = edge_residual<G>(
        G::inverse(G::from(measured(closure))), poses[closure.from], poses[closure.to]);
    const Square J = at.by_to * G::adjoint(G::inverse(poses[closure.to]));
    const Square steps = sum[closure.to] - sum[closure.from];
    const Square own = inverse_of(G::information(closure, 1.0));
    out.push_back(closure_error<G>(at.error, J * steps * J.transpose() + own));
  }
  return out;
}

}  // namespace loopbench::methods
