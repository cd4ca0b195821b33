#include "methods/correctors/looped_chain.hpp"

#include <utility>

#include "datasets/core/covariance.hpp"
#include "methods/correctors/chain.hpp"

namespace loopbench::methods {
namespace {

constexpr double kRounding = 1e-12;  // relative rounding error of a cost summed over a chain

/// Returns a + share b.
std::vector<Twist> add_scaled(std::vector<Twist> a, double share, const std::vector<Twist>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += share * b[i];
  return a;
}

/// Returns the sum of eta' S_L^-1 eta over the loops.
double loop_squares(const Eigen::VectorXd& loop_residuals, const NoiseModel& noise_model) {
  double sum = 0.0;
  for (std::size_t k = 0; k < noise_model.closure_information.size(); ++k) {
    const Twist eta = of_closure(loop_residuals, k);
    sum += eta.dot(noise_model.closure_information[k] * eta);
  }
  return sum;
}

}  // namespace

LoopedChain::LoopedChain(const Problem& problem,
                         NoiseModel noise_model,
                         std::vector<std::optional<Vector3>> points)
    : problem_(problem),
      sums_(problem.closures),
      poses_(problem.keyframes.size()),
      points_(std::move(points)) {
  points_.resize(problem.closures.size());
  Vector3 sum = Vector3::Zero();
  for (const StampedPose& k : problem.keyframes) sum += k.world_from_body.translation;
  centre_ = sum / static_cast<double>(problem.keyframes.size());
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    poses_[i] = problem.keyframes[i].world_from_body;
    poses_[i].translation -= centre_;
  }
  for (const Edge& edge : problem.odometry) {
    motions_.push_back(edge.from_from_to);
    errors_.push_back(edge_error(edge, poses_[edge.from], poses_[edge.to]));
  }
  set_noise_model(std::move(noise_model));
}

void LoopedChain::set_noise_model(NoiseModel noise_model) {
  noise_model_ = std::move(noise_model);
  cost_ = cost_of(errors_, loop_residuals(poses_));
  is_near_minimum_ = false;
}

void LoopedChain::set_errors(std::vector<Twist> errors) {
  errors_ = std::move(errors);
  poses_ = integrate(errors_);
  cost_ = cost_of(errors_, loop_residuals(poses_));
  is_near_minimum_ = false;
}

double LoopedChain::cost_of(const std::vector<Twist>& errors,
                            const Eigen::VectorXd& loop_residuals) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    sum += errors[i].dot(noise_model_.information[i] * errors[i]);
  }
  return 0.5 * (sum + loop_squares(loop_residuals, noise_model_));
}

LoopedChain::Candidate LoopedChain::candidate(std::vector<Twist> errors) const {
  Candidate out{std::move(errors), {}, {}};
  out.poses = integrate(out.errors);
  out.loop_residuals = loop_residuals(out.poses);
  out.cost = cost_of(out.errors, out.loop_residuals);
  return out;
}

void LoopedChain::close_loops(Candidate& trial, const LoopEquations& equations) const {
  constexpr int kRounds = 3;
  constexpr double kClosed = 1e-6;  // remaining residual of the loops, as a fraction of the cost
  const LoopJacobian& jacobian = equations.jacobian;
  const Eigen::VectorXd predicted =
      jacobian.gap + loop_residual_change(jacobian, sums_, trial.errors);
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::VectorXd remaining = trial.loop_residuals - predicted;
    if (!(loop_squares(remaining, noise_model_) > kClosed * cost_)) return;
    trial = candidate(add_scaled(
        trial.errors,
        1.0,
        minimum_cost_corrections(equations, remaining, problem_.closures, noise_model_)));
  }
}

bool LoopedChain::step_towards(const std::vector<Twist>& target,
                               const LoopEquations& equations,
                               double min_length) {
  const std::vector<Twist> direction = add_scaled(target, -1.0, errors_);
  for (double length = 1.0; length >= min_length; length *= 0.5) {
    Candidate trial = candidate(add_scaled(errors_, length, direction));
    close_loops(trial, equations);
    // Where the cost is flat to rounding, a full step still improves the poses.
    if (trial.cost < cost_ || (length == 1.0 && trial.cost <= cost_ * (1.0 + kRounding))) {
      is_near_minimum_ = trial.cost > 0.5 * cost_;
      errors_ = std::move(trial.errors);
      poses_ = std::move(trial.poses);
      cost_ = trial.cost;
      return true;
    }
  }
  return false;
}

std::vector<Twist> LoopedChain::gradient(const LoopJacobian& jacobian) const {
  Eigen::VectorXd weighted = loop_residuals(poses_);
  for (std::size_t k = 0; k < problem_.closures.size(); ++k) {
    auto each = of_closure(weighted, k);
    each = (noise_model_.closure_information[k] * each).eval();
  }
  const std::vector<Twist> pull =
      constraint_force_increments(jacobian.loop, errors_.size(), problem_.closures, weighted);
  std::vector<Twist> out(errors_.size());
  Twist sum = Twist::Zero();
  for (std::size_t i = 0; i < errors_.size(); ++i) {
    sum += pull[i];
    const Twist by_error = jacobian.edge[i].transpose() * sum;
    out[i] = noise_model_.information[i] * errors_[i] + by_error;
  }
  return out;
}

bool LoopedChain::step() {
  const LoopEquations equations = this->equations();
  if (is_near_minimum_) {
    const std::vector<Twist> direction = newton_direction(
        equations, gradient(equations.jacobian), sums_, problem_.closures, noise_model_);
    if (step_towards(add_scaled(errors_, 1.0, direction), equations, 0.25)) return true;
  }
  const Eigen::VectorXd& gap = equations.jacobian.gap;
  return step_towards(
      minimum_cost_corrections(equations, gap, problem_.closures, noise_model_), equations, 1e-4);
}

int LoopedChain::minimise(int max_iterations, double tolerance) {
  int iterations = 0;
  while (iterations < max_iterations) {
    const double before = cost_;
    if (!step()) break;
    ++iterations;
    if (before - cost_ <= tolerance * before) break;
  }
  return iterations;
}

Eigen::VectorXd LoopedChain::loop_residuals(const std::vector<Pose>& poses) const {
  Eigen::VectorXd out(static_cast<Eigen::Index>(6 * problem_.closures.size()));
  for (std::size_t k = 0; k < problem_.closures.size(); ++k) {
    const Edge& loop = problem_.closures[k];
    const Pose& from = poses[loop.from];
    const Pose& to = poses[loop.to];
    if (measures_position(k)) {
      const Vector3 reached =
          from.rotation.conjugate() *
          Vector3(to.rotation * *points_[k] + to.translation - from.translation);
      of_closure(out, k) = twist(reached - loop.from_from_to.translation, Vector3::Zero());
    } else {
      of_closure(out, k) = edge_error(loop, from, to);
    }
  }
  return out;
}

Matrix6 LoopedChain::loop_jacobian(std::size_t closure, const Twist& error) const {
  const Edge& loop = problem_.closures[closure];
  const Pose& to = poses_[loop.to];
  if (!measures_position(closure)) {
    return inverse_right_jacobian_se3(error) * adjoint(to.inverse());
  }
  // The point moves by rho + phi x point.
  const Matrix3 back = poses_[loop.from].rotation.conjugate().toRotationMatrix();
  Matrix6 out = Matrix6::Zero();
  out.topLeftCorner<3, 3>() = back;
  out.topRightCorner<3, 3>() = -back * hat(to.rotation * *points_[closure] + to.translation);
  return out;
}

LoopJacobian LoopedChain::linearise() const {
  LoopJacobian out;
  out.edge.resize(errors_.size());
  for (std::size_t i = 0; i < errors_.size(); ++i) out.edge[i] = edge_jacobian(i);
  out.gap = loop_residuals(poses_);
  for (std::size_t k = 0; k < problem_.closures.size(); ++k) {
    out.loop.push_back(loop_jacobian(k, of_closure(out.gap, k)));
  }
  out.gap -= loop_residual_change(out, sums_, errors_);
  return out;
}

std::vector<Pose> LoopedChain::integrate(const std::vector<Twist>& errors) const {
  std::vector<Pose> out(poses_.size());
  out.front() = poses_.front();
  for (std::size_t i = 0; i < errors.size(); ++i) {
    out[i + 1] = normalized(out[i] * motions_[i] * exp_se3(errors[i]));
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

/// An error e_i moves all later poses by the twist edge[i] e_i in the axes of the chain. With the
/// sum P_j of edge[i] S_i edge[i]' up to keyframe j and M = A S A' + S_L = F F', the covariance of
/// its twist is P_j - C_j' M^-1 C_j = P_j - Y_j' Y_j, where C_j is that of all gaps with the twist
/// and Y_j = F^-1 C_j. Along an edge, the rows of C of the loops that contain it grow by loop[k]
/// edge[i] S_i edge[i]'. The information of the first edge is removed by Woodbury's identity: with
/// X = P_1 - Y_j' Y_1, the covariance of the twists j and 1, it grows by X (Y_1' Y_1)^-1 X'.
std::vector<Matrix6> LoopedChain::covariances(bool has_front) const {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 6>;
  const LoopEquations at = equations();
  const std::vector<Edge>& closures = problem_.closures;
  const auto size = static_cast<Eigen::Index>(6 * closures.size());
  Eigen::MatrixXd by_loop = Eigen::MatrixXd::Zero(size, size);  // F^-1 loop[k], one per loop
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const auto begin = static_cast<Eigen::Index>(6 * k);
    by_loop.block<6, 6>(begin, begin) = at.jacobian.loop[k];
  }
  at.factor.matrixL().solveInPlace(by_loop);
  const auto of_loop = [&](std::size_t k) {
    return by_loop.middleCols<6>(static_cast<Eigen::Index>(6 * k));
  };
  std::vector<std::vector<std::size_t>> begin(poses_.size()), end(poses_.size());
  for (std::size_t k = 0; k < closures.size(); ++k) {
    begin[closures[k].from].push_back(k);
    end[closures[k].to].push_back(k);
  }
  std::vector<Matrix6> out(poses_.size(), Matrix6::Zero());
  Rows active = Rows::Zero(size, 6);   // sum of F^-1 loop[k] over the loops that contain the edge
  Rows shared = Rows::Zero(size, 6);   // Y_j
  Matrix6 open = Matrix6::Zero();      // P_j
  Rows front = Rows::Zero(size, 6);    // Y_1
  Matrix6 of_front = Matrix6::Zero();  // P_1
  for (std::size_t j = 1; j < poses_.size(); ++j) {
    for (const std::size_t k : begin[j - 1]) active += of_loop(k);
    for (const std::size_t k : end[j - 1]) active -= of_loop(k);
    const Matrix6& edge = at.jacobian.edge[j - 1];
    const Matrix6 added = edge * noise_model_.covariance[j - 1] * edge.transpose();
    open += added;
    shared.noalias() += active * added;
    Matrix6 of_twist = open;
    of_twist.noalias() -= shared.transpose() * shared;
    if (has_front) {
      if (j == 1) front = shared, of_front = open;
      const Matrix6 cross = of_front - shared.transpose() * front;
      // In the plane, other axes may be free.
      const Matrix6 known = front.transpose() * front;
      const Matrix6 gain = known.completeOrthogonalDecomposition().solve(cross.transpose());
      of_twist += cross * gain;
    }
    out[j] = displaced(0.5 * (of_twist + of_twist.transpose()), poses_[j].translation);
    if (problem_.planar) out[j] = planar_covariance(out[j], poses_[j].rotation.toRotationMatrix());
  }
  return out;
}

}  // namespace loopbench::methods
