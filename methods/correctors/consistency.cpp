#include "methods/correctors/consistency.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "methods/correctors/max_clique.hpp"
#include "methods/correctors/plausibility.hpp"

namespace loopbench::methods {
namespace {

/// The chain integrated from odometry alone, starting at the identity, with prefix sums of its
/// covariance.
class CheckedChain {
 public:
  explicit CheckedChain(const Problem& problem) {
    poses_.emplace_back();
    noise_.emplace_back(Matrix6::Zero());
    for (const Edge& edge : problem.odometry) {
      poses_.push_back(normalized(poses_.back() * edge.from_from_to));
      const Matrix6 B = adjoint(poses_.back());
      const Matrix6 S = edge.information.inverse();
      noise_.push_back(noise_.back() + B * S * B.transpose());
    }
  }

  PairError loop(const Edge& k, const Edge& l) const {
    const Pose d_from_b = poses_[l.to].inverse() * poses_[k.to];
    const Pose c_from_b = l.from_from_to * d_from_b;
    const Pose a_from_c = poses_[k.from].inverse() * poses_[l.from];
    const Pose b_from_b = normalized(k.from_from_to.inverse() * (a_from_c * c_from_b));
    PairError out;
    out.error = log_se3(b_from_b);

    // Transforms noise from the chain's first frame to frame b, along either part of the odometry.
    const Matrix6 G = adjoint(c_from_b.inverse() * poses_[l.from].inverse());
    const Matrix6 H = adjoint(poses_[k.to].inverse());
    const double forward_ac = k.from <= l.from ? 1.0 : -1.0;
    const double forward_db = l.to <= k.to ? 1.0 : -1.0;
    const auto [ac_begin, ac_end] = std::minmax(k.from, l.from);
    const auto [db_begin, db_end] = std::minmax(l.to, k.to);
    const std::size_t begin = std::max(ac_begin, db_begin);
    const std::size_t end = std::max(begin, std::min(ac_end, db_end));
    const Matrix6 shared = noise_[end] - noise_[begin];
    const Matrix6 M = forward_ac * G + forward_db * H;
    const Matrix6 only_ac = noise_[ac_end] - noise_[ac_begin] - shared;
    const Matrix6 only_db = noise_[db_end] - noise_[db_begin] - shared;
    const Matrix6 D = adjoint(d_from_b.inverse());
    out.covariance = k.information.inverse() + D * l.information.inverse() * D.transpose() +
                     G * only_ac * G.transpose() + H * only_db * H.transpose() +
                     M * shared * M.transpose();
    return out;
  }

 private:
  std::vector<Pose> poses_;
  std::vector<Matrix6> noise_;
};

double squared(const PairError& pair) {
  return pair.error.dot(pair.covariance.ldlt().solve(pair.error));
}

}  // namespace

PairError pair_error(const Problem& problem, const Edge& first, const Edge& second) {
  return CheckedChain(problem).loop(first, second);
}

ConsistentClosures consistent_closures(const Problem& problem) {
  constexpr std::size_t kMaxSteps = 100000;  // of the exact clique search
  const std::vector<Edge>& closures = problem.closures;
  if (closures.size() < 2) return {std::vector<std::size_t>(closures.size(), 0), true};
  const CheckedChain chain(problem);
  const double threshold = inlier_chi2(problem.planar ? 3 : 6);
  BitGraph agree(closures.size());
  for (std::size_t k = 0; k < closures.size(); ++k) {
    for (std::size_t l = 0; l < k; ++l) {
      if (squared(chain.loop(closures[k], closures[l])) < threshold) agree.join(k, l);
    }
  }
  Clique clique = max_clique(agree, kMaxSteps);
  if (clique.members.size() < 2) clique.members.clear();
  return {std::move(clique.members), clique.is_largest};
}

}  // namespace loopbench::methods
