#include "methods/correctors/looped_chain.hpp"

#include "methods/correctors/chain.hpp"
#include "methods/correctors/loop_newton.hpp"

namespace loopbench {
namespace {

constexpr double kRounding = 1e-12;  // of a cost summed over a chain, relative

/// a + share b.
Corrections sum_of(Corrections a, double share, const Corrections& b) {
  for (std::size_t i = 0; i < a.errors.size(); ++i) a.errors[i] += share * b.errors[i];
  for (std::size_t j = 0; j < a.drift.size(); ++j) a.drift[j] += share * b.drift[j];
  return a;
}

/// sum of eta' S_L^-1 eta.
double loop_squares(const Eigen::VectorXd& loop_errors, const ChainBelief& belief) {
  double sum = 0.0;
  for (std::size_t k = 0; k < belief.closure_information.size(); ++k) {
    const Twist eta = loop_errors.segment<6>(static_cast<Eigen::Index>(6 * k));
    sum += eta.dot(belief.closure_information[k] * eta);
  }
  return sum;
}

/// What no drift explains of edge i's error.
Twist noise_of(const Corrections& at, const ChainBelief& belief, std::size_t i) {
  Twist w = at.errors[i];
  for (std::size_t j = 0; j < at.drift.size(); ++j) {
    w -= belief.drift[j].shape[i].cwiseProduct(at.drift[j]);
  }
  return w;
}

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
    : problem_(problem), sums_(problem.closures), poses_(problem.keyframes.size()) {
  Vector3 sum = Vector3::Zero();
  for (const StampedPose& k : problem.keyframes) sum += k.world_from_body.translation;
  centre_ = sum / static_cast<double>(problem.keyframes.size());
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    poses_[i] = problem.keyframes[i].world_from_body;
    poses_[i].translation -= centre_;
  }
  for (const Edge& edge : problem.odometry) {
    at_.errors.push_back(edge_error(edge, poses_[edge.from], poses_[edge.to]));
  }
  believe(std::move(belief));
}

void LoopedChain::believe(ChainBelief belief) {
  belief_ = std::move(belief);
  at_.drift.resize(belief_.drift.size(), Twist::Zero());
  for (std::size_t j = 0; j < at_.drift.size(); ++j) {
    for (Eigen::Index axis = 0; axis < 6; ++axis) {
      if (belief_.drift[j].variance[axis] == 0.0) at_.drift[j][axis] = 0.0;
    }
  }
  cost_ = cost_of(at_, loop_errors(poses_));
  near_ = false;
}

void LoopedChain::correct_by(std::vector<Twist> errors) {
  at_.errors = std::move(errors);
  poses_ = integrate(at_.errors);
  cost_ = cost_of(at_, loop_errors(poses_));
  near_ = false;
}

double LoopedChain::cost_of(const Corrections& at, const Eigen::VectorXd& loop_errors) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < at.errors.size(); ++i) {
    const Twist w = noise_of(at, belief_, i);
    sum += w.dot(belief_.information[i] * w);
  }
  for (std::size_t j = 0; j < at.drift.size(); ++j) {
    for (Eigen::Index axis = 0; axis < 6; ++axis) {
      const double beta = at.drift[j][axis];
      if (beta != 0.0) sum += beta * beta / belief_.drift[j].variance[axis];
    }
  }
  return 0.5 * (sum + loop_squares(loop_errors, belief_));
}

LoopedChain::Candidate LoopedChain::candidate(Corrections at) const {
  Candidate out{std::move(at), {}, {}};
  out.poses = integrate(out.at.errors);
  out.loop_errors = loop_errors(out.poses);
  out.cost = cost_of(out.at, out.loop_errors);
  return out;
}

void LoopedChain::close_loops(Candidate& tried, const LoopEquations& equations) const {
  constexpr int kRounds = 3;
  constexpr double kClosed = 1e-6;  // of the cost, what loops left open may matter
  const LoopJacobian& jacobian = equations.jacobian;
  const Eigen::VectorXd meant = jacobian.gap + along_loops(jacobian, sums_, tried.at.errors);
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::VectorXd open = tried.loop_errors - meant;
    if (!(loop_squares(open, belief_) > kClosed * cost_)) return;
    tried =
        candidate(sum_of(tried.at, 1.0, least_cost(equations, open, problem_.closures, belief_)));
  }
}

bool LoopedChain::step_towards(const Corrections& wanted,
                               const LoopEquations& equations,
                               double shortest) {
  const Corrections way = sum_of(wanted, -1.0, at_);
  for (double length = 1.0; length >= shortest; length *= 0.5) {
    Candidate tried = candidate(sum_of(at_, length, way));
    close_loops(tried, equations);
    // Where the cost is flat to rounding, the full step still brings the poses nearer.
    if (tried.cost < cost_ || (length == 1.0 && tried.cost <= cost_ * (1.0 + kRounding))) {
      near_ = tried.cost > 0.5 * cost_;
      at_ = std::move(tried.at);
      poses_ = std::move(tried.poses);
      cost_ = tried.cost;
      return true;
    }
  }
  return false;
}

bool LoopedChain::step() {
  const LoopEquations equations = loop_equations(linearised(), sums_, belief_);
  if (near_) {
    const Corrections way = newton_direction(
        equations, gradient(equations.jacobian), sums_, problem_.closures, belief_);
    if (step_towards(sum_of(at_, 1.0, way), equations, 0.25)) return true;
  }
  const Eigen::VectorXd& gap = equations.jacobian.gap;
  return step_towards(least_cost(equations, gap, problem_.closures, belief_), equations, 1e-4);
}

Eigen::VectorXd LoopedChain::loop_errors(const std::vector<Pose>& poses) const {
  Eigen::VectorXd out(static_cast<Eigen::Index>(6 * problem_.closures.size()));
  for (std::size_t k = 0; k < problem_.closures.size(); ++k) {
    const Edge& loop = problem_.closures[k];
    out.segment<6>(static_cast<Eigen::Index>(6 * k)) =
        edge_error(loop, poses[loop.from], poses[loop.to]);
  }
  return out;
}

LoopJacobian LoopedChain::linearised() const {
  LoopJacobian out;
  out.edge.resize(at_.errors.size());
  for (std::size_t i = 0; i < at_.errors.size(); ++i) {
    out.edge[i] = adjoint(poses_[i + 1]) * right_jacobian_se3(at_.errors[i]);
  }
  out.gap = loop_errors(poses_);
  for (std::size_t k = 0; k < problem_.closures.size(); ++k) {
    const Twist eta = out.gap.segment<6>(static_cast<Eigen::Index>(6 * k));
    out.loop.push_back(inverse_right_jacobian_se3(eta) *
                       adjoint(poses_[problem_.closures[k].to].inverse()));
  }
  out.gap -= along_loops(out, sums_, at_.errors);
  return out;
}

Corrections LoopedChain::gradient(const LoopJacobian& jacobian) const {
  Eigen::VectorXd weighted = loop_errors(poses_);
  for (std::size_t k = 0; k < problem_.closures.size(); ++k) {
    auto each = weighted.segment<6>(static_cast<Eigen::Index>(6 * k));
    each = (belief_.closure_information[k] * each).eval();
  }
  const std::vector<Twist> pull = loop_pull(jacobian, problem_.closures, weighted);
  Corrections out{at_.errors, at_.drift};
  for (std::size_t j = 0; j < at_.drift.size(); ++j) {
    const Twist& variance = belief_.drift[j].variance;
    out.drift[j] = (variance.array() > 0.0).select(at_.drift[j].cwiseQuotient(variance), 0.0);
  }
  Twist sum = Twist::Zero();
  for (std::size_t i = 0; i < at_.errors.size(); ++i) {
    sum += pull[i];
    const Twist by_error = jacobian.edge[i].transpose() * sum;
    out.errors[i] = belief_.information[i] * noise_of(at_, belief_, i) + by_error;
    for (std::size_t j = 0; j < at_.drift.size(); ++j) {
      out.drift[j] += belief_.drift[j].shape[i].cwiseProduct(by_error);
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

}  // namespace loopbench
