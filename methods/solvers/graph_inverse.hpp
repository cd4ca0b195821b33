/// Covariances between the poses of a solved pose graph.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "methods/solvers/block_cholesky.hpp"
#include "methods/solvers/graph_covariance.hpp"

namespace loopbench::methods {

/// Information of a pose graph about d in X Exp(d) of each pose, factorised: solutions with it, and
/// blocks of its inverse. Pose 0 has neither if it is fixed.
template <class G>
class GraphInverse {
 public:
  static constexpr int D = G::kDof;
  using Square = typename G::Square;
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

  /// `poses`: the minimum of solve_pose_graph() for the problem, with `settings` without a loss and
  /// weights of 1. `further`: pairs of poses whose block of the inverse is wanted, beside those of
  /// the edges. Throws std::runtime_error if the information is not positive definite. Time and
  /// memory of a few factorisations.
  GraphInverse(const std::vector<ScaledPose>& poses,
               const Problem& problem,
               const PoseGraphSettings& settings,
               const Pairs& further = {})
      : first_(settings.is_first_free ? 0 : 1),
        structure_(static_cast<int>(poses.size()) - first_, pairs(problem, further)),
        factor_(structure_) {
    factor_.set_zero();
    const ScaledPose first_from_world = poses.front().inverse();
    std::vector<typename G::Element> at;
    at.reserve(poses.size());
    for (const ScaledPose& each : poses) at.push_back(G::from(first_from_world * each));
    for (const auto* edges : {&problem.odometry, &problem.closures}) {
      for (const Edge& edge : *edges) add(edge, at[edge.from], at[edge.to], settings.scale_sigma);
    }
    for (const Anchor& anchor : settings.anchors) {
      const int i = block_of(anchor.keyframe);
      if (i < 0) continue;
      factor_.add(factor_.location(i, i),
                  anchor_information<G>(anchor, poses[anchor.keyframe].pose));
    }
    if (!factor_.factorise()) {
      throw std::runtime_error("the information of the graph is not positive definite");
    }
    inverse_.emplace(factor_);
    inverse_->invert();
  }
  GraphInverse(const GraphInverse&) = delete;
  GraphInverse& operator=(const GraphInverse&) = delete;

  /// Covariance of the poses i and j, which an edge or a further pair joins.
  Square covariance(std::size_t i, std::size_t j) const {
    const int a = block_of(i), b = block_of(j);
    if (a < 0 || b < 0) return Square::Zero();
    return inverse_->inverse_block(inverse_->location(a, b));
  }

  /// Replaces columns of D rows per pose by the inverse times them; the rows of a fixed pose by 0.
  void solve(Eigen::MatrixXd& columns) {
    Eigen::MatrixXd free = columns.bottomRows(structure_.blocks() * D);
    factor_.solve(free);
    columns.setZero();
    columns.bottomRows(structure_.blocks() * D) = free;
  }

 private:
  /// -1: the fixed pose.
  int block_of(std::size_t pose) const { return static_cast<int>(pose) - first_; }

  std::vector<std::pair<int, int>> pairs(const Problem& problem, const Pairs& further) const {
    std::vector<std::pair<int, int>> out;
    const auto add_pair = [&](std::size_t i, std::size_t j) {
      const int a = block_of(i), b = block_of(j);
      if (a >= 0 && b >= 0 && a != b) out.emplace_back(a, b);
    };
    for (const auto* edges : {&problem.odometry, &problem.closures}) {
      for (const Edge& edge : *edges) add_pair(edge.from, edge.to);
    }
    for (const auto& [i, j] : further) add_pair(i, j);
    return out;
  }

  void add(const Edge& edge,
           const typename G::Element& from,
           const typename G::Element& to,
           double scale_sigma) {
    const EdgeResidual<G> at = edge_residual<G>(G::inverse(G::from(measured(edge))), from, to);
    const Square omega = G::information(edge, scale_sigma);
    const int i = block_of(edge.from), j = block_of(edge.to);
    if (i >= 0) factor_.add(factor_.location(i, i), at.by_from.transpose() * omega * at.by_from);
    if (j >= 0) factor_.add(factor_.location(j, j), at.by_to.transpose() * omega * at.by_to);
    if (i >= 0 && j >= 0) {
      factor_.add(factor_.location(i, j), at.by_from.transpose() * omega * at.by_to);
    }
  }

  int first_;
  EliminationStructure structure_;
  BlockCholesky<D> factor_;
  std::optional<BlockCholesky<D>> inverse_;
};

}  // namespace loopbench::methods
