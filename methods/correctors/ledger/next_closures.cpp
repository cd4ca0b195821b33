#include "methods/correctors/ledger/next_closures.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "methods/correctors/ledger/solution.hpp"
#include "methods/correctors/stiffness.hpp"
#include "methods/solvers/graph_inverse.hpp"
#include "methods/solvers/groups/se2.hpp"
#include "methods/solvers/groups/se3.hpp"

namespace loopbench::methods {
namespace {

/// Covariance of the closure in the middle of all, by its information on positions.
template <class G>
typename G::Square typical_covariance(const std::vector<Edge>& closures) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < closures.size(); ++k) {
    order.emplace_back(closures[k].information.diagonal().head<3>().sum(), k);
  }
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
  std::nth_element(order.begin(), middle, order.end());
  return inverse_of(G::information(closures[middle->second], 1.0));
}

/// Covariances between all poses and some of them.
template <class G>
class Candidates {
 public:
  static constexpr Eigen::Index D = G::kDof;
  static constexpr Eigen::Index kAxes = D == 3 ? 2 : 3;  // of a position
  using Square = typename G::Square;

  Candidates(const Problem& problem, const LedgerSolution& at)
      : poses_(at.poses), own_(typical_covariance<G>(problem.closures)) {
    constexpr std::size_t kMost = 40;
    GraphInverse<G> inverse(at.poses, problem, at.settings);
    const std::size_t poses = at.poses.size(), count = std::min(kMost, poses);
    for (std::size_t i = 0; i < count; ++i) {
      keyframes_.push_back(count > 1 ? i * (poses - 1) / (count - 1) : 0);
    }
    const auto columns = D * static_cast<Eigen::Index>(count);
    covariance_.resize(columns, columns);
    gram_.resize(columns, columns);
    for (std::size_t i = 0; i < count; ++i) add(i, inverse);
    for (std::size_t k = 0; k < poses; ++k) {
      const Square block = inverse.covariance(k, k);
      variance_ += block.diagonal().template head<kAxes>().sum();
    }
    for (const Edge& closure : problem.closures) {
      longest_ = std::max(longest_, closure.from_from_to.translation.norm());
    }
  }

  double deviation(double decrease = 0.0) const {
    const double left = std::max(0.0, variance_ - decrease);
    return std::sqrt(left / static_cast<double>(poses_.size()));
  }

  /// Decreases of the sum of all variances [m^2], the largest first.
  std::vector<std::pair<double, NextClosure>> sorted() const {
    std::vector<std::pair<double, NextClosure>> out;
    for (std::size_t j = 0; j < keyframes_.size(); ++j) {
      for (std::size_t i = 0; i < j; ++i) consider(i, j, out);
    }
    std::ranges::stable_sort(out, std::greater{}, [](const auto& each) { return each.first; });
    return out;
  }

 private:
  static Eigen::Index row(std::size_t i) { return D * static_cast<Eigen::Index>(i); }

  /// With P the rows of positions: the columns of the covariance C of candidate i, and those of
  /// C P' P C by a second solution, so that no covariances with all poses are kept.
  void add(std::size_t i, GraphInverse<G>& inverse) {
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(row(poses_.size()), D);
    columns.middleRows<D>(row(keyframes_[i])).setIdentity();
    const auto keep = [&](Eigen::MatrixXd& into) {
      inverse.solve(columns);
      for (std::size_t k = 0; k < keyframes_.size(); ++k) {
        into.block<D, D>(row(k), row(i)) = columns.middleRows<D>(row(keyframes_[k]));
      }
    };
    keep(covariance_);
    for (std::size_t k = 0; k < poses_.size(); ++k) {
      columns.middleRows<D - kAxes>(row(k) + kAxes).setZero();
    }
    keep(gram_);
  }

  void consider(std::size_t i,
                std::size_t j,
                std::vector<std::pair<double, NextClosure>>& out) const {
    const Pose from_from_to = poses_[keyframes_[i]].pose.inverse() * poses_[keyframes_[j]].pose;
    const Square by_from = -G::adjoint(G::inverse(G::from(ScaledPose{from_from_to, 1.0})));
    const auto through = [&](const Eigen::MatrixXd& of) -> Square {
      const Square cross = by_from * of.block<D, D>(row(i), row(j));
      return by_from * of.block<D, D>(row(i), row(i)) * by_from.transpose() +
             of.block<D, D>(row(j), row(j)) + cross + cross.transpose();
    };
    const Square predicted = through(covariance_);
    const double metres = from_from_to.translation.norm();
    const double spread = std::sqrt(predicted.diagonal().template head<kAxes>().sum());
    if (metres > longest_ + 2.0 * spread) return;
    const double decrease =
        Eigen::LLT<Square>(Square(predicted + own_)).solve(through(gram_)).trace();
    out.push_back({decrease, {keyframes_[i], keyframes_[j], metres, deviation(decrease)}});
  }

  const std::vector<ScaledPose>& poses_;
  Square own_;
  std::vector<std::size_t> keyframes_;
  Eigen::MatrixXd covariance_;  ///< between the candidates
  Eigen::MatrixXd gram_;        ///< of the covariances between the candidates and all positions
  double variance_ = 0.0;       ///< sum over all positions [m^2]
  double longest_ = 0.0;        ///< closure [m]
};

template <class G>
NextClosures most_effective(const Problem& stated, std::size_t count) {
  const Problem problem = with_bounded_stiffness(stated);
  const LedgerSolution at = ledger_solution(problem);
  const Candidates<G> candidates(problem, at);
  NextClosures out{candidates.deviation(), {}};
  const std::size_t apart = problem.keyframes.size() / 10;
  const auto is_near = [&](std::size_t a, std::size_t b) {
    return std::max(a, b) - std::min(a, b) <= apart;
  };
  for (const auto& candidate : candidates.sorted()) {
    if (out.found.size() == count) break;
    const NextClosure& next = candidate.second;
    const bool is_known = std::ranges::any_of(out.found, [&](const NextClosure& each) {
      return is_near(each.from, next.from) && is_near(each.to, next.to);
    });
    if (!is_known) out.found.push_back(next);
  }
  return out;
}

}  // namespace

NextClosures next_closures(const Problem& problem, std::size_t count) {
  return problem.planar ? most_effective<Se2>(problem, count) : most_effective<Se3>(problem, count);
}

}  // namespace loopbench::methods
