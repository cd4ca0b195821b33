#include "methods/correctors/looped_chain.hpp"

#include <Eigen/Cholesky>
#include <stdexcept>

#include "methods/correctors/chain.hpp"

namespace loopbench {
namespace {

constexpr double kRounding = 1e-12;  // of a cost summed over a chain, relative

}  // namespace

ChainBelief stated_belief(const Problem& problem) {
  ChainBelief out;
  for (const Edge& edge : problem.odometry) {
    out.information.push_back(edge.information);
    out.covariance.push_back(edge.information.inverse());
  }
  for (const Edge& loop : problem.closures) {
    out.closure_information.push_back(loop.information);
    out.closure_covariance.push_back(loop.information.inverse());
  }
  return out;
}

LoopedChain::LoopedChain(const Problem& problem, ChainBelief belief)
    : problem_(problem),
      sums_(problem.closures),
      poses_(problem.keyframes.size()),
      errors_(problem.odometry.size()) {
  Vector3 sum = Vector3::Zero();
  for (const StampedPose& k : problem.keyframes) sum += k.world_from_body.translation;
  centre_ = sum / static_cast<double>(problem.keyframes.size());
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    poses_[i] = problem.keyframes[i].world_from_body;
    poses_[i].translation -= centre_;
  }
  for (const Edge& edge : problem.odometry) {
    errors_[edge.from] = edge_error(edge, poses_[edge.from], poses_[edge.to]);
  }
  believe(std::move(belief));
}

void LoopedChain::believe(ChainBelief belief) {
  belief_ = std::move(belief);
  drift_.resize(belief_.drift.size(), Twist::Zero());
  for (std::size_t j = 0; j < drift_.size(); ++j) {
    for (Eigen::Index axis = 0; axis < 6; ++axis) {
      if (belief_.drift[j].variance[axis] == 0.0) drift_[j][axis] = 0.0;
    }
  }
  cost_ = cost_of({errors_, drift_}, poses_);
}

void LoopedChain::correct_by(std::vector<Twist> errors) {
  errors_ = std::move(errors);
  poses_ = integrate(errors_);
  cost_ = cost_of({errors_, drift_}, poses_);
}

double LoopedChain::cost_of(const Corrections& at, const std::vector<Pose>& poses) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < at.errors.size(); ++i) {
    Twist w = at.errors[i];
    for (std::size_t j = 0; j < at.drift.size(); ++j) {
      w -= belief_.drift[j].shape[i].cwiseProduct(at.drift[j]);
    }
    sum += w.dot(belief_.information[i] * w);
  }
  for (std::size_t j = 0; j < at.drift.size(); ++j) {
    for (Eigen::Index axis = 0; axis < 6; ++axis) {
      const double beta = at.drift[j][axis];
      if (beta != 0.0) sum += beta * beta / belief_.drift[j].variance[axis];
    }
  }
  for (std::size_t k = 0; k < problem_.closures.size(); ++k) {
    const Edge& loop = problem_.closures[k];
    const Twist eta = edge_error(loop, poses[loop.from], poses[loop.to]);
    sum += eta.dot(belief_.closure_information[k] * eta);
  }
  return 0.5 * sum;
}

bool LoopedChain::step() {
  const Corrections wanted = solve();
  for (double length = 1.0; length > 1e-4; length *= 0.5) {
    Corrections at{errors_, drift_};
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      at.errors[i] += length * (wanted.errors[i] - errors_[i]);
    }
    for (std::size_t j = 0; j < drift_.size(); ++j) {
      at.drift[j] += length * (wanted.drift[j] - drift_[j]);
    }
    std::vector<Pose> poses = integrate(at.errors);
    const double cost = cost_of(at, poses);
    // Where the cost is flat to rounding, the full step still brings the poses nearer.
    if (cost < cost_ || (length == 1.0 && cost <= cost_ * (1.0 + kRounding))) {
      errors_ = std::move(at.errors);
      drift_ = std::move(at.drift);
      poses_ = std::move(poses);
      cost_ = cost;
      return true;
    }
  }
  return false;
}

LoopJacobian LoopedChain::linearised() const {
  LoopJacobian out;
  out.edge.resize(errors_.size());
  std::vector<Twist> running;  // of edge[i] e_i, at the cuts
  running.reserve(sums_.cuts().size());
  Twist total = Twist::Zero();
  std::size_t cut = 0;
  for (std::size_t i = 0; i <= errors_.size(); ++i) {
    if (cut < sums_.cuts().size() && sums_.cuts()[cut] == i) {
      running.push_back(total);
      ++cut;
    }
    if (i == errors_.size()) break;
    out.edge[i] = adjoint(poses_[i + 1]) * right_jacobian_se3(errors_[i]);
    total += out.edge[i] * errors_[i];
  }
  out.gap.resize(static_cast<Eigen::Index>(6 * problem_.closures.size()));
  for (std::size_t k = 0; k < problem_.closures.size(); ++k) {
    const Edge& loop = problem_.closures[k];
    const Twist eta = edge_error(loop, poses_[loop.from], poses_[loop.to]);
    out.loop.push_back(inverse_right_jacobian_se3(eta) * adjoint(poses_[loop.to].inverse()));
    out.gap.segment<6>(static_cast<Eigen::Index>(6 * k)) =
        eta - out.loop.back() * sums_.over(running, k);
  }
  return out;
}

LoopedChain::Corrections LoopedChain::solve() const {
  const LoopJacobian jacobian = linearised();
  Eigen::MatrixXd equations = through_loops(
      jacobian, sums_, running_sum(sums_, [&](std::size_t i) -> Matrix6 {
        return jacobian.edge[i] * belief_.covariance[i] * jacobian.edge[i].transpose();
      }));
  for (std::size_t k = 0; k < sums_.loops(); ++k) {
    const auto row = static_cast<Eigen::Index>(6 * k);
    equations.block<6, 6>(row, row) += belief_.closure_covariance[k];
  }
  std::vector<Eigen::MatrixXd> shapes;  // what each drift does to the loops
  for (const ChainBelief::Drift& drift : belief_.drift) {
    shapes.push_back(
        through_loops_once(jacobian, sums_, running_sum(sums_, [&](std::size_t i) -> Matrix6 {
                             return jacobian.edge[i] * drift.shape[i].asDiagonal();
                           })));
    const Eigen::MatrixXd weighted = shapes.back() * drift.variance.asDiagonal();
    equations.triangularView<Eigen::Lower>() += weighted * shapes.back().transpose();
  }
  const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factor(equations);
  if (factor.info() != Eigen::Success) {
    throw std::runtime_error("the loop equations are not positive definite");
  }
  const Eigen::VectorXd lambda = factor.solve(jacobian.gap);

  Corrections out;
  for (std::size_t j = 0; j < shapes.size(); ++j) {
    out.drift.push_back(
        -belief_.drift[j].variance.cwiseProduct(Twist(shapes[j].transpose() * lambda)));
  }
  // What all loops over an edge pull at it, as a running sum along the chain.
  std::vector<Twist> pull(errors_.size() + 1, Twist::Zero());
  for (std::size_t k = 0; k < problem_.closures.size(); ++k) {
    const Edge& loop = problem_.closures[k];
    const Twist p =
        jacobian.loop[k].transpose() * lambda.segment<6>(static_cast<Eigen::Index>(6 * k));
    pull[loop.from] += p;
    pull[loop.to] -= p;
  }
  out.errors.resize(errors_.size());
  Twist sum = Twist::Zero();
  for (std::size_t i = 0; i < errors_.size(); ++i) {
    sum += pull[i];
    out.errors[i] = -belief_.covariance[i] * (jacobian.edge[i].transpose() * sum);
    for (std::size_t j = 0; j < out.drift.size(); ++j) {
      out.errors[i] += belief_.drift[j].shape[i].cwiseProduct(out.drift[j]);
    }
  }
  return out;
}

std::vector<Pose> LoopedChain::integrate(const std::vector<Twist>& errors) const {
  std::vector<Pose> out(poses_.size());
  out.front() = poses_.front();
  for (std::size_t i = 0; i < errors.size(); ++i) {
    out[i + 1] = normalized(out[i] * problem_.odometry[i].from_from_to * exp_se3(errors[i]));
  }
  return out;
}

Trajectory LoopedChain::keyframes() const {
  Trajectory out = problem_.keyframes;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].world_from_body = poses_[i];
    out[i].world_from_body.translation += centre_;
  }
  return out;
}

Eigen::MatrixXd through_loops(const LoopJacobian& jacobian,
                              const LoopSums& sums,
                              const std::vector<Matrix6>& running) {
  const auto size = static_cast<Eigen::Index>(6 * sums.loops());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t k = 0; k < sums.loops(); ++k) {
    for (std::size_t l = 0; l <= k; ++l) {
      if (!sums.overlap(k, l)) continue;
      out.block<6, 6>(static_cast<Eigen::Index>(6 * k), static_cast<Eigen::Index>(6 * l)) =
          jacobian.loop[k] * sums.over_both(running, k, l) * jacobian.loop[l].transpose();
    }
  }
  return out;
}

Eigen::MatrixXd through_loops_once(const LoopJacobian& jacobian,
                                   const LoopSums& sums,
                                   const std::vector<Matrix6>& running) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(6 * sums.loops()), 6);
  for (std::size_t k = 0; k < sums.loops(); ++k) {
    out.middleRows<6>(static_cast<Eigen::Index>(6 * k)) = jacobian.loop[k] * sums.over(running, k);
  }
  return out;
}

}  // namespace loopbench
