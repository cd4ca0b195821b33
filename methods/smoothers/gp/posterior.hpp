/// Most probable states of a Gaussian process on SE(3), given noisy poses.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "datasets/core/covariance.hpp"
#include "datasets/core/trajectory.hpp"
#include "methods/smoothers/gp/link.hpp"

namespace loopbench::methods {

/// Hyperparameters. The unit of time is the mean interval between the poses.
struct GpParameters {
  double sigma_t, sigma_r;  ///< standard deviation of a measured pose [m], [rad]
  double power_t, power_r;  ///< power of the driving noise [m^2], [rad^2] per interval
};

/// 1 / standard deviation of each row, where each six rows are translation and then rotation.
template <int Rows>
Eigen::Matrix<double, Rows, 1> row_weights(double variance_t, double variance_r) {
  Eigen::Matrix<double, Rows, 1> out;
  for (int row = 0; row < Rows; ++row) {
    out[row] = 1.0 / std::sqrt(row % 6 < 3 ? variance_t : variance_r);
  }
  return out;
}

/// Minimises, by Gauss-Newton on the block tridiagonal normal equations,
///
///     1/2 sum_i |Log(M_i^-1 T_i)|^2_R + 1/2 sum_i |link(state_i, state_{i+1})|^2_Q,
///
/// with blocks of size 12. O(n) per iteration. Source: Anderson & Barfoot 2015; Barfoot, ch. 11.
class GpPosterior {
 public:
  using States = std::vector<GpState>;

  /// Requires at least three poses.
  explicit GpPosterior(const Trajectory& measured)
      : interval_((measured.back().stamp - measured.front().stamp) /
                  static_cast<double>(measured.size() - 1)) {
    for (std::size_t i = 0; i < measured.size(); ++i) {
      measured_.push_back(measured[i].world_from_body);
      if (i > 0) intervals_.push_back((measured[i].stamp - measured[i - 1].stamp) / interval_);
      const Vector3 from_start = measured_[i].translation - measured_[0].translation;
      extent_ = std::max(extent_, from_start.norm());
    }
  }

  double interval() const { return interval_; }                      ///< mean [s]
  double interval_of(std::size_t i) const { return intervals_[i]; }  ///< [mean intervals]

  /// Initial states: the measured poses, and rates from finite differences.
  States initial_states() const {
    const std::size_t n = measured_.size();
    States out(n);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, n - 1);
      double time = 0.0;
      for (std::size_t k = before; k < after; ++k) time += intervals_[k];
      out[i].pose = measured_[i];
      out[i].rate = log_se3(measured_[before].inverse() * measured_[after]) / time;
    }
    return out;
  }

  /// Minimises the cost starting from `states`; returns the number of iterations. Deterministic.
  /// Throws std::runtime_error when the normal equations are not positive definite.
  int solve(States& states, const GpParameters& parameters) const {
    constexpr int kMostSteps = 30;
    constexpr int kMostHalvings = 10;
    constexpr double kConverged = 1e-12;  // relative to the extent, and [rad]
    constexpr double kRounding = 1e-9;  // smaller steps are accepted without a decrease of the cost
    std::vector<Step> steps(states.size());
    double current_cost = cost(states, parameters);
    for (int iteration = 1; iteration <= kMostSteps; ++iteration) {
      eliminate(states, parameters, &steps);
      std::vector<GpVector> step(states.size());
      double largest = 0.0;
      for (std::size_t i = states.size(); i-- > 0;) {
        step[i] = steps[i].offset;
        if (i + 1 < states.size()) step[i] -= steps[i].to_next * step[i + 1];
        largest =
            std::max({largest, step[i].head<3>().norm() / extent_, step[i].segment<3>(3).norm()});
      }
      bool better = false;
      double share = 1.0;
      for (int halving = 0; halving <= kMostHalvings && !better; ++halving, share *= 0.5) {
        States trial = states;
        for (std::size_t i = 0; i < states.size(); ++i) {
          const GpVector part = share * step[i];
          trial[i].pose = normalized(trial[i].pose * exp_se3(part.head<6>()));
          trial[i].rate += part.tail<6>();
        }
        const double trial_cost = cost(trial, parameters);
        better = trial_cost < current_cost || largest < kRounding;
        if (!better) continue;
        current_cost = trial_cost;
        states = std::move(trial);
      }
      if (largest < kConverged || !better) return iteration;
    }
    return kMostSteps;
  }

  /// Returns -log p(measured | parameters) up to a constant by the Laplace approximation at
  /// `states`: the cost at its linearised minimum + half the log determinants of the normal matrix,
  /// of Q and of R. One elimination, O(n).
  double negative_evidence(const States& states, const GpParameters& parameters) const {
    const Elimination at = eliminate(states, parameters, nullptr);
    const auto poses = static_cast<double>(measured_.size());
    const double log_links = 6.0 * std::log(parameters.power_t * parameters.power_r);
    const double log_poses = 6.0 * std::log(parameters.sigma_t * parameters.sigma_r);
    return at.cost - at.decrease +
           0.5 * (at.log_determinant + (poses - 1.0) * log_links + poses * log_poses);
  }

  /// Returns the covariance of each pose in fixed axes (datasets/core/covariance.hpp) to first
  /// order at `states`, the solution. One elimination and one pass back, O(n).
  std::vector<Matrix6> covariances(const States& states, const GpParameters& parameters) const {
    std::vector<Step> steps(states.size());
    eliminate(states, parameters, &steps);
    std::vector<Matrix6> out(states.size());
    GpMatrix of_next = GpMatrix::Zero();
    for (std::size_t i = states.size(); i-- > 0;) {
      const auto& [to_next, offset, schur] = steps[i];
      of_next = (schur.llt().solve(GpMatrix::Identity()) + to_next * of_next * to_next.transpose())
                    .eval();
      const Matrix6 of_pose = of_next.topLeftCorner<6, 6>();
      out[i] = rotated(0.5 * (of_pose + of_pose.transpose()),
                       states[i].pose.rotation.toRotationMatrix());
    }
    return out;
  }

 private:
  struct Step {
    GpMatrix to_next;  ///< delta_i = offset - to_next * delta_{i + 1}
    GpVector offset;
    GpMatrix schur;  ///< information of delta_i given delta_{i + 1}
  };
  struct Elimination {
    double cost, decrease, log_determinant;
  };
  Elimination eliminate(const States& states,
                        const GpParameters& parameters,
                        std::vector<Step>* steps) const {
    const auto pose_weights = row_weights<6>(parameters.sigma_t * parameters.sigma_t,
                                             parameters.sigma_r * parameters.sigma_r);
    const auto link_weights = row_weights<12>(parameters.power_t, parameters.power_r);
    Elimination out{0.0, 0.0, 0.0};
    GpMatrix block = GpMatrix::Zero();  // Schur complement of the earlier states
    GpVector gradient = GpVector::Zero();
    for (std::size_t i = 0; i < states.size(); ++i) {
      const Twist residual = log_se3(measured_[i].inverse() * states[i].pose);
      const Matrix6 J = pose_weights.asDiagonal() * inverse_right_jacobian_se3(residual);
      const Twist whitened = pose_weights.cwiseProduct(residual);
      block.topLeftCorner<6, 6>() += J.transpose() * J;
      gradient.head<6>() += J.transpose() * whitened;
      out.cost += 0.5 * whitened.squaredNorm();

      const bool is_last = i + 1 == states.size();
      Link next;
      GpMatrix coupling = GpMatrix::Zero();
      if (!is_last) {
        next = link(states[i], states[i + 1], intervals_[i]);
        next.error = link_weights.cwiseProduct(next.error).eval();
        next.by_from = (link_weights.asDiagonal() * next.by_from).eval();
        next.by_to = (link_weights.asDiagonal() * next.by_to).eval();
        block.noalias() += next.by_from.transpose() * next.by_from;
        gradient.noalias() += next.by_from.transpose() * next.error;
        coupling.noalias() = next.by_from.transpose() * next.by_to;
        out.cost += 0.5 * next.error.squaredNorm();
      }
      const Eigen::LLT<GpMatrix> factor(block);
      if (factor.info() != Eigen::Success) {
        throw std::runtime_error("gp: the normal equations are not positive definite at keyframe " +
                                 std::to_string(i));
      }
      out.log_determinant += 2.0 * factor.matrixLLT().diagonal().array().log().sum();
      const GpVector offset = factor.solve(gradient);
      out.decrease += 0.5 * gradient.dot(offset);
      const GpMatrix to_next = factor.solve(coupling);
      if (steps != nullptr) (*steps)[i] = {to_next, -offset, block};
      if (is_last) break;
      block.noalias() = next.by_to.transpose() * next.by_to;
      block.noalias() -= coupling.transpose() * to_next;
      gradient = (next.by_to.transpose() * next.error - coupling.transpose() * offset).eval();
    }
    return out;
  }

  double cost(const States& states, const GpParameters& parameters) const {
    const auto pose_weights = row_weights<6>(parameters.sigma_t * parameters.sigma_t,
                                             parameters.sigma_r * parameters.sigma_r);
    const auto link_weights = row_weights<12>(parameters.power_t, parameters.power_r);
    double sum = 0.0;
    for (std::size_t i = 0; i < states.size(); ++i) {
      const Twist residual = log_se3(measured_[i].inverse() * states[i].pose);
      sum += pose_weights.cwiseProduct(residual).squaredNorm();
      if (i == 0) continue;
      const GpVector error = link(states[i - 1], states[i], intervals_[i - 1]).error;
      sum += link_weights.cwiseProduct(error).squaredNorm();
    }
    return 0.5 * sum;
  }

  std::vector<Pose> measured_;
  std::vector<double> intervals_;  ///< between the poses [mean intervals]
  double interval_;
  double extent_ = 1.0;  ///< scale of the convergence threshold, at least 1 [m]
};

}  // namespace loopbench::methods
