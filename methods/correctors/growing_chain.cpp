/// Chains of problems that grow.
#include "methods/correctors/looped_chain.hpp"

namespace loopbench::methods {

void LoopedChain::grow() {
  for (std::size_t i = errors_.size(); i < problem_.odometry.size(); ++i) {
    const Edge& edge = problem_.odometry[i];
    noise_model_.information.push_back(edge.information);
    noise_model_.covariance.push_back(edge.information.inverse());
    motions_.push_back(edge.from_from_to);
    errors_.emplace_back(Twist::Zero());
    poses_.push_back(normalized(poses_.back() * edge.from_from_to));
  }
  for (std::size_t k = noise_model_.closure_covariance.size(); k < problem_.closures.size(); ++k) {
    const Edge& loop = problem_.closures[k];
    noise_model_.closure_information.push_back(loop.information);
    noise_model_.closure_covariance.push_back(loop.information.inverse());
  }
  points_.resize(problem_.closures.size());
  sums_ = LoopSums(problem_.closures);
  cost_ = cost_of(errors_, loop_errors(poses_));
}

void LoopedChain::extend(LoopEquations& equations) const {
  LoopJacobian& jacobian = equations.jacobian;
  for (std::size_t i = jacobian.edge.size(); i < errors_.size(); ++i) {
    jacobian.edge.push_back(edge_jacobian(i));
  }
  const Eigen::VectorXd errors = loop_errors(poses_);
  for (std::size_t k = jacobian.loop.size(); k < problem_.closures.size(); ++k) {
    jacobian.loop.push_back(loop_jacobian(k, of_closure(errors, k)));
  }
  append_closures(equations, sums_, noise_model_);
}

void LoopedChain::remove_closure(std::size_t k) {
  if (k >= noise_model_.closure_covariance.size()) return;  // not known here
  const auto at = static_cast<std::ptrdiff_t>(k);
  noise_model_.closure_covariance.erase(noise_model_.closure_covariance.begin() + at);
  noise_model_.closure_information.erase(noise_model_.closure_information.begin() + at);
  points_.erase(points_.begin() + at);
}

}  // namespace loopbench::methods
