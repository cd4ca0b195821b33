/// Normal equations of the edges and anchors of a pose graph.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "methods/solvers/block_cholesky.hpp"
#include "methods/solvers/elimination_structure.hpp"
#include "methods/solvers/pose_graph_solver.hpp"
#include "methods/solvers/residuals.hpp"

namespace loopbench::methods {

/// J' J d = -J' r of the residuals r of solve_pose_graph() without loss. The pattern of the matrix
/// and the order of its elimination are computed once; linearise() and solve() allocate nothing.
template <class G>
class NormalEquations {
 public:
  using Element = typename G::Element;
  using Tangent = typename G::Tangent;
  using Square = typename G::Square;

  /// `cache` must outlive this object and not be used for other edges meanwhile.
  NormalEquations(std::size_t poses,
                  const WeightedEdges& edges,
                  const PoseGraphSettings& settings,
                  EliminationCache& cache)
      : first_(settings.is_first_free ? 0 : 1),
        terms_(terms_of(edges, settings.scale_sigma)),
        structure_(cache.of(static_cast<int>(poses) - first_, pairs())),
        factor_(structure_) {
    diagonal_locations_.reserve(static_cast<std::size_t>(structure_.blocks()));
    for (int i = 0; i < structure_.blocks(); ++i)
      diagonal_locations_.push_back(factor_.location(i, i));
    for (Term& term : terms_) {
      const int from = block(term.from), to = block(term.to);
      if (std::min(from, to) >= 0) term.between = factor_.location(from, to);
    }
    for (const Anchor& anchor : settings.anchors) {
      anchors_.push_back({anchor, anchor.covariance.inverse().llt().matrixU()});
    }
    gradient_.resize(structure_.blocks() * G::kDof);
  }

  /// Index of the first pose that is estimated: 0 or 1.
  std::size_t first() const { return static_cast<std::size_t>(first_); }

  /// Returns half the sum of squared residuals.
  double cost(const std::vector<Element>& x) const {
    double sum = 0.0;
    for (const Term& term : terms_) {
      const Element from_from_to = G::compose(G::inverse(x[term.from]), x[term.to]);
      sum += (term.root * group_edge_error<G>(term.back, from_from_to)).squaredNorm();
    }
    for (const WhitenedAnchor& each : anchors_) {
      const Pose at = G::to_scaled_pose(x[each.anchor.keyframe]).pose;
      sum += (each.root * anchor_error(each.anchor, at)).squaredNorm();
    }
    return 0.5 * sum;
  }

  /// Assembles the equations at `x` and returns the cost there.
  double linearise(const std::vector<Element>& x) {
    factor_.set_zero();
    gradient_.setZero();
    double sum = 0.0;
    for (const Term& term : terms_) {
      const Element from_from_to = G::compose(G::inverse(x[term.from]), x[term.to]);
      const Tangent error = group_edge_error<G>(term.back, from_from_to);
      const Tangent whitened = term.root * error;
      sum += whitened.squaredNorm();
      const Square J = term.root * G::inverse_right_jacobian(error);  // by the second pose
      const Square H = J.transpose() * J;
      const Tangent g = J.transpose() * whitened;
      const int from = block(term.from), to = block(term.to);
      if (to >= 0) add(to, H, g);
      if (from < 0) continue;
      // The derivative by the first pose is -J M; see edge_residual().
      const Square M = G::adjoint(G::inverse(from_from_to));
      const Square MH = M.transpose() * H;
      add(from, MH * M, -(M.transpose() * g));
      if (to >= 0) factor_.add(term.between, -MH);
    }
    for (const WhitenedAnchor& each : anchors_) {
      const Pose at = G::to_scaled_pose(x[each.anchor.keyframe]).pose;
      const AnchorResidual residual = anchor_residual(each.anchor, at);
      const Vector3 whitened = each.root * residual.error;
      sum += whitened.squaredNorm();
      const int anchored = block(each.anchor.keyframe);
      if (anchored < 0) continue;
      Eigen::Matrix<double, 3, G::kDof> J = Eigen::Matrix<double, 3, G::kDof>::Zero();
      for (int i = 0; i < std::min(G::kDof, 6); ++i) {
        J.col(i) = each.root * residual.by_pose.col(twist_axis<G>(i));
      }
      add(anchored, J.transpose() * J, J.transpose() * whitened);
    }
    return 0.5 * sum;
  }

  struct Step {
    Eigen::VectorXd values;     ///< kDof numbers per estimated pose
    double predicted_decrease;  ///< of the cost
  };

  /// Solves (H + damping diag(H)) d = -g once per linearise(). False: not positive definite.
  bool solve(double damping, Step& step) {
    step.values = -gradient_;
    if (!factor_.solve_damped(damping, diagonal_, step.values)) return false;
    double sum = 0.0;
    for (int i = 0; i < structure_.blocks(); ++i) {
      const auto d = step.values.template segment<G::kDof>(i * G::kDof).array();
      const auto g = gradient_.template segment<G::kDof>(i * G::kDof).array();
      const auto scale =
          diagonal_.template segment<G::kDof>(structure_.position(i) * G::kDof).array();
      sum += ((damping * scale * d - g) * d).sum();
    }
    step.predicted_decrease = 0.5 * sum;
    return true;
  }

 private:
  struct Term {
    std::size_t from;
    std::size_t to;
    Element back;  ///< inverse of the measurement
    Square root;
    typename BlockCholesky<G::kDof>::Location between;
  };
  struct WhitenedAnchor {
    Anchor anchor;
    Matrix3 root;
  };

  static std::vector<Term> terms_of(const WeightedEdges& edges, double scale_sigma) {
    std::vector<Term> out;
    out.reserve(edges.odometry.size() + edges.closures.size());
    edges.for_each([&](const Edge& edge, double weight, bool) {
      out.push_back({edge.from,
                     edge.to,
                     G::inverse(G::from(measured(edge))),
                     information_root<G>(edge, weight, scale_sigma),
                     {}});
    });
    return out;
  }

  /// Pairs of estimated poses that a term connects.
  std::vector<std::pair<int, int>> pairs() const {
    std::vector<std::pair<int, int>> out;
    out.reserve(terms_.size());
    for (const Term& term : terms_) {
      const int i = block(term.from), j = block(term.to);
      if (std::min(i, j) >= 0) out.emplace_back(i, j);
    }
    return out;
  }

  /// -1: the fixed pose.
  int block(std::size_t pose) const { return static_cast<int>(pose) - first_; }
  void add(int block, const Square& H, const Tangent& g) {
    factor_.add(diagonal_locations_[static_cast<std::size_t>(block)], H);
    gradient_.template segment<G::kDof>(block * G::kDof) += g;
  }

  int first_;
  std::vector<Term> terms_;
  const EliminationStructure& structure_;
  BlockCholesky<G::kDof> factor_;
  std::vector<typename BlockCholesky<G::kDof>::Location> diagonal_locations_;
  std::vector<WhitenedAnchor> anchors_;
  Eigen::VectorXd gradient_;
  Eigen::VectorXd diagonal_;  ///< in the order of elimination
};

}  // namespace loopbench::methods
