#include "methods/correctors/loop_equations.hpp"

#include <stdexcept>

#include "datasets/core/factorisations.hpp"

namespace loopbench::methods {
namespace {

using Twists = std::vector<Twist>;  // one per edge

double inner_product(const Twists& a, const Twists& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

/// Returns B(q) y: the c with x' c = q' [x, y] for every x.
Twist bracket(const Twist& q, const Twist& y) {
  const Vector3 force = q.head<3>(), moment = q.tail<3>();
  const Vector3 rho = y.head<3>(), phi = y.tail<3>();
  return twist(phi.cross(force), rho.cross(force) + phi.cross(moment));
}

/// Covariance of errors that cannot leave the plane: a lower minimum can be out of it. Correlated
/// errors out of the plane are known to be zero, so this is no block of the inverse.
Matrix6 covariance_in_plane(Matrix6 information) {
  const Twist diagonal = information.diagonal();
  const auto clear = [](Matrix6& matrix) {
    for (const int axis : {2, 3, 4}) {
      matrix.row(axis).setZero();
      matrix.col(axis).setZero();
    }
  };
  clear(information);
  information.diagonal() = diagonal;
  Matrix6 out = inverse_of(information);
  clear(out);
  return out;
}

class NewtonSystem {
 public:
  NewtonSystem(const LoopEquations& equations,
               const LoopSums& sums,
               const std::vector<Edge>& closures,
               const NoiseModel& noise_model)
      : jacobian_(equations.jacobian),
        equations_(equations),
        sums_(sums),
        closures_(closures),
        noise_model_(noise_model),
        edges_(jacobian_.edge.size()) {
    const Eigen::VectorXd lambda = equations.factor.solve(jacobian_.gap);
    for (std::size_t k = 0; k < closures.size(); ++k) {
      wrench_of_.push_back(jacobian_.loop[k].transpose() * of_closure(lambda, k));
    }
    wrench_ = constraint_force_increments(jacobian_.loop, edges_, closures, lambda);
    for (std::size_t i = 1; i < wrench_.size(); ++i) wrench_[i] += wrench_[i - 1];
  }

  /// Returns M^-1 v = S v - S A' (A S A' + S_L)^-1 A S v.
  Twists preconditioned(const Twists& v) const {
    Twists out(v.size());
    for (std::size_t i = 0; i < edges_; ++i) out[i] = noise_model_.covariance[i] * v[i];
    const Eigen::VectorXd lambda =
        equations_.factor.solve(loop_residual_change(jacobian_, sums_, out));
    const Twists pull = constraint_force_increments(jacobian_.loop, edges_, closures_, lambda);
    Twist sum = Twist::Zero();
    for (std::size_t i = 0; i < edges_; ++i) {
      sum += pull[i];
      out[i] -= noise_model_.covariance[i] * (jacobian_.edge[i].transpose() * sum);
    }
    return out;
  }

  /// Returns N v. In each loop, edges j after edge i enter as +x_j and edges before it as -x_j.
  Twists curvature_product(const Twists& v) const {
    Twists before(edges_ + 1);  // sum of x_j, j < i
    before[0].setZero();
    for (std::size_t i = 0; i < edges_; ++i) {
      before[i + 1] = before[i] + jacobian_.edge[i] * v[i];
    }
    Twists change(edges_ + 1, Twist::Zero());  // at the first and last keyframe of each loop
    for (std::size_t k = 0; k < closures_.size(); ++k) {
      const Edge& loop = closures_[k];
      const Twist ends = bracket(wrench_of_[k], before[loop.to] + before[loop.from]);
      change[loop.from] += ends;
      change[loop.to] -= ends;
    }
    Twists out(v.size(), Twist::Zero());
    Twist sum = Twist::Zero();
    for (std::size_t i = 0; i < edges_; ++i) {
      sum += change[i];
      out[i] = 0.5 * (jacobian_.edge[i].transpose() *
                      (sum - bracket(wrench_[i], before[i + 1] + before[i])));
    }
    return out;
  }

 private:
  const LoopJacobian& jacobian_;
  const LoopEquations& equations_;
  const LoopSums& sums_;
  const std::vector<Edge>& closures_;
  const NoiseModel& noise_model_;
  std::size_t edges_;
  Twists wrench_of_;  ///< of each loop
  Twists wrench_;     ///< sum over the loops that enclose each edge
};

/// Solves (M + N) d = r with preconditioned conjugate gradients.
Twists solved(const NewtonSystem& system, Twists r) {
  constexpr int kMaxIterations = 50;
  constexpr double kForcing = 0.03;  // relative residual in the norm of M^-1
  Twists d(r.size(), Twist::Zero());
  Twists z = system.preconditioned(r);
  Twists p = z, Mp = r;  // M z = r, so products with M are never computed
  double rz = inner_product(r, z);
  const double threshold = kForcing * kForcing * rz;
  for (int k = 0; k < kMaxIterations && rz > threshold; ++k) {
    Twists Hp = system.curvature_product(p);
    for (std::size_t i = 0; i < Hp.size(); ++i) Hp[i] += Mp[i];
    const double curvature = inner_product(p, Hp);
    if (!(curvature > 0.0)) return k == 0 ? z : d;
    const double length = rz / curvature;
    for (std::size_t i = 0; i < d.size(); ++i) {
      d[i] += length * p[i];
      r[i] -= length * Hp[i];
    }
    z = system.preconditioned(r);
    const double before = rz;
    rz = inner_product(r, z);
    for (std::size_t i = 0; i < p.size(); ++i) {
      p[i] = z[i] + rz / before * p[i];
      Mp[i] = r[i] + rz / before * Mp[i];
    }
  }
  return d;
}

}  // namespace

NoiseModel stated_noise_model(const Problem& problem) {
  NoiseModel out;
  for (const Edge& edge : problem.odometry) {
    out.information.push_back(edge.information);
    out.covariance.push_back(problem.planar ? covariance_in_plane(edge.information)
                                            : inverse_of(edge.information));
  }
  for (const Edge& loop : problem.closures) {
    out.closure_information.push_back(loop.information);
    out.closure_covariance.push_back(inverse_of(loop.information));
  }
  return out;
}

LoopEquations loop_equations(LoopJacobian jacobian,
                             const LoopSums& sums,
                             const NoiseModel& noise_model) {
  Eigen::MatrixXd matrix = propagate_covariance(
      jacobian, sums, running_sum(sums, [&](std::size_t i) -> Matrix6 {
        return jacobian.edge[i] * noise_model.covariance[i] * jacobian.edge[i].transpose();
      }));
  for (std::size_t k = 0; k < sums.loops(); ++k) {
    const auto row = static_cast<Eigen::Index>(6 * k);
    matrix.block<6, 6>(row, row) += noise_model.closure_covariance[k];
  }
  LoopEquations out;
  out.factor.compute(matrix);
  if (out.factor.info() != Eigen::Success) {
    throw std::runtime_error("the loop equations are not positive definite");
  }
  out.jacobian = std::move(jacobian);
  return out;
}

std::vector<Twist> minimum_cost_corrections(const LoopEquations& equations,
                                            const Eigen::VectorXd& gap,
                                            const std::vector<Edge>& closures,
                                            const NoiseModel& noise_model) {
  const Eigen::VectorXd lambda = equations.factor.solve(gap);
  const std::vector<Twist> pull = constraint_force_increments(
      equations.jacobian.loop, equations.jacobian.edge.size(), closures, lambda);
  std::vector<Twist> out(equations.jacobian.edge.size());
  Twist sum = Twist::Zero();
  for (std::size_t i = 0; i < out.size(); ++i) {
    sum += pull[i];
    out[i] = -noise_model.covariance[i] * (equations.jacobian.edge[i].transpose() * sum);
  }
  return out;
}

Eigen::VectorXd loop_residual_change(const LoopJacobian& jacobian,
                                     const LoopSums& sums,
                                     const std::vector<Twist>& errors) {
  const std::vector<Twist> running =
      running_sum(sums, [&](std::size_t i) -> Twist { return jacobian.edge[i] * errors[i]; });
  Eigen::VectorXd out(static_cast<Eigen::Index>(6 * sums.loops()));
  for (std::size_t k = 0; k < sums.loops(); ++k) {
    of_closure(out, k) = jacobian.loop[k] * sums.over(running, k);
  }
  return out;
}

std::vector<Twist> constraint_force_increments(const std::vector<Matrix6>& loop,
                                               std::size_t edges,
                                               const std::vector<Edge>& closures,
                                               const Eigen::VectorXd& lambda) {
  std::vector<Twist> out(edges + 1, Twist::Zero());
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const Twist pull = loop[k].transpose() * of_closure(lambda, k);
    out[closures[k].from] += pull;
    out[closures[k].to] -= pull;
  }
  return out;
}

Eigen::MatrixXd propagate_covariance(const LoopJacobian& jacobian,
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

std::vector<Twist> newton_direction(const LoopEquations& equations,
                                    const std::vector<Twist>& gradient,
                                    const LoopSums& sums,
                                    const std::vector<Edge>& closures,
                                    const NoiseModel& noise_model) {
  Twists downhill;
  downhill.reserve(gradient.size());
  for (const Twist& each : gradient) downhill.push_back(-each);
  return solved(NewtonSystem(equations, sums, closures, noise_model), std::move(downhill));
}

}  // namespace loopbench::methods
