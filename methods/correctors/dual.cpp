#include "methods/correctors/dual.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "methods/correctors/chain.hpp"

namespace loopbench {
namespace {

/// The chain at its current corrections. Positions are relative to the chain's centroid: adjoints
/// grow with the distance from the origin and would cost digits far from it.
class LoopedChain {
 public:
  explicit LoopedChain(const Problem& problem)
      : problem_(problem), poses_(problem.keyframes.size()), errors_(problem.odometry.size()) {
    Vector3 sum = Vector3::Zero();
    for (const StampedPose& k : problem.keyframes) sum += k.world_from_body.translation;
    centre_ = sum / static_cast<double>(problem.keyframes.size());
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      poses_[i] = problem.keyframes[i].world_from_body;
      poses_[i].translation -= centre_;
    }
    covariances_.reserve(errors_.size());
    for (const Edge& edge : problem.odometry) {
      covariances_.push_back(edge.information.inverse());
      errors_[edge.from] = edge_error(edge, poses_[edge.from], poses_[edge.to]);
    }
    for (const Edge& loop : problem.closures) {
      closure_covariances_.push_back(loop.information.inverse());
    }
    cost_ = chain_cost(problem_, poses_);
  }

  double cost() const { return cost_; }

  /// One Gauss-Newton step, halved until the cost falls. False when no step lowers it.
  bool step() {
    const std::vector<Twist> wanted = solve();
    for (double length = 1.0; length > 1e-4; length *= 0.5) {
      std::vector<Twist> errors(errors_.size());
      for (std::size_t i = 0; i < errors.size(); ++i) {
        errors[i] = errors_[i] + length * (wanted[i] - errors_[i]);
      }
      std::vector<Pose> poses = integrate(errors);
      const double cost = chain_cost(problem_, poses);
      if (cost < cost_) {
        errors_ = std::move(errors);
        poses_ = std::move(poses);
        cost_ = cost;
        return true;
      }
    }
    return false;
  }

  Trajectory keyframes() const {
    Trajectory out = problem_.keyframes;
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].world_from_body = poses_[i];
      out[i].world_from_body.translation += centre_;
    }
    return out;
  }

 private:
  /// The corrections that minimise the linearised cost.
  std::vector<Twist> solve() const {
    const std::size_t n = errors_.size();
    const std::vector<Edge>& loops = problem_.closures;
    // Prefix sums over the edges: P of B S B', q of B e, with B_i = Ad(X_i) J(e_i).
    std::vector<Matrix6> B(n);
    std::vector<Matrix6> P(n + 1, Matrix6::Zero());
    std::vector<Twist> q(n + 1, Twist::Zero());
    for (std::size_t i = 0; i < n; ++i) {
      B[i] = adjoint(poses_[i + 1]) * right_jacobian_se3(errors_[i]);
      P[i + 1] = P[i] + B[i] * covariances_[i] * B[i].transpose();
      q[i + 1] = q[i] + B[i] * errors_[i];
    }
    const auto K = static_cast<Eigen::Index>(loops.size());
    std::vector<Matrix6> M(loops.size());  // A_ki = M_k B_i inside the loop
    Eigen::MatrixXd H(6 * K, 6 * K);
    Eigen::VectorXd c(6 * K);
    for (Eigen::Index k = 0; k < K; ++k) {
      const Edge& loop = loops[static_cast<std::size_t>(k)];
      const Twist eta = edge_error(loop, poses_[loop.from], poses_[loop.to]);
      Matrix6& m = M[static_cast<std::size_t>(k)];
      m = inverse_right_jacobian_se3(eta) * adjoint(poses_[loop.to].inverse());
      c.segment<6>(6 * k) = eta - m * (q[loop.to] - q[loop.from]);
      for (Eigen::Index l = 0; l <= k; ++l) {
        const Edge& other = loops[static_cast<std::size_t>(l)];
        const std::size_t begin = std::max(loop.from, other.from);
        const std::size_t end = std::min(loop.to, other.to);
        Matrix6 block = Matrix6::Zero();
        if (begin < end) {
          block = m * (P[end] - P[begin]) * M[static_cast<std::size_t>(l)].transpose();
        }
        if (k == l) block += closure_covariances_[static_cast<std::size_t>(k)];
        H.block<6, 6>(6 * k, 6 * l) = block;
      }
    }
    const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factor(H);
    if (factor.info() != Eigen::Success) {
      throw std::runtime_error("dual: the loop equations are not positive definite");
    }
    const Eigen::VectorXd lambda = factor.solve(c);

    // What all loops over an edge pull at it, as a running sum along the chain.
    std::vector<Twist> pull(n + 1, Twist::Zero());
    for (std::size_t k = 0; k < loops.size(); ++k) {
      const Twist p = M[k].transpose() * lambda.segment<6>(6 * static_cast<Eigen::Index>(k));
      pull[loops[k].from] += p;
      pull[loops[k].to] -= p;
    }
    std::vector<Twist> out(n);
    Twist sum = Twist::Zero();
    for (std::size_t i = 0; i < n; ++i) {
      sum += pull[i];
      out[i] = -covariances_[i] * (B[i].transpose() * sum);
    }
    return out;
  }

  std::vector<Pose> integrate(const std::vector<Twist>& errors) const {
    std::vector<Pose> out(poses_.size());
    out.front() = poses_.front();
    for (std::size_t i = 0; i < errors.size(); ++i) {
      out[i + 1] = normalized(out[i] * problem_.odometry[i].from_from_to * exp_se3(errors[i]));
    }
    return out;
  }

  const Problem& problem_;
  std::vector<Pose> poses_;
  std::vector<Twist> errors_;  ///< e_i of odometry edge i
  std::vector<Matrix6> covariances_;
  std::vector<Matrix6> closure_covariances_;
  Vector3 centre_;
  double cost_ = 0.0;
};

}  // namespace

std::optional<std::string> Dual::declines(const Problem& problem) const {
  if (problem.closures.empty()) return "no loop closure to spread";
  if (problem.closures.size() > static_cast<std::size_t>(options_.max_closures)) {
    return std::to_string(problem.closures.size()) +
           " closures, more than max_closures = " + std::to_string(options_.max_closures);
  }
  if (const std::string fault = chain_fault(problem); !fault.empty()) return fault;
  return std::nullopt;
}

Trajectory Dual::correct(const Problem& problem, Report& report) const {
  LoopedChain chain(problem);
  report.count("cost_before", chain.cost());
  if (!std::isfinite(chain.cost())) throw std::runtime_error("dual: the cost is not finite");
  int iterations = 0;
  while (iterations < options_.max_iterations) {
    const double before = chain.cost();
    if (!chain.step()) break;
    ++iterations;
    if (before - chain.cost() <= options_.tolerance * before) break;
  }
  report.count("iterations", iterations);
  report.count("cost", chain.cost());
  return chain.keyframes();
}

}  // namespace loopbench
