/// Likelihood of neighbouring loops together, with fitted sizes of the noise.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "metrics/doctor/closure_chain.hpp"

namespace loopbench::metrics {

/// Errors with which the odometry and the other closures of a group predict each closure.
struct PredictionError {
  std::vector<double> metres;
  std::vector<double> radians;
};

/// A few closures with the odometry that their loops share, which explains a part of their gaps
/// together.
class LoopGroup {
 public:
  LoopGroup(std::vector<const Edge*> closures, const Chain& chain);

  const std::vector<const Edge*>& closures() const { return closures_; }

  /// Gaussian log likelihood of the gaps if the closures were `measured`. The stated variances of
  /// odometry and closures are multiplied by the factors that fit best. Appends the errors of
  /// predictions with these factors to `errors`. O(closures^3).
  double log_likelihood(const std::vector<Pose>& measured, PredictionError* errors = nullptr) const;

 private:
  using Logarithms = std::array<double, 2>;  // of the factors

  Eigen::VectorXd gaps(const std::vector<Pose>& measured) const;
  Eigen::MatrixXd covariance(const Logarithms& factors) const;
  double log_likelihood_of(const Eigen::VectorXd& values, const Logarithms& factors) const;
  double pattern_search(const Eigen::VectorXd& values, Logarithms& at) const;
  void add_errors(const Eigen::VectorXd& values,
                  const Logarithms& factors,
                  PredictionError& errors) const;

  std::vector<const Edge*> closures_;
  const Chain& chain_;
  Eigen::MatrixXd of_odometry_, of_closures_;  ///< covariances as stated
};

inline constexpr double kLeastVariance = 1e-12;  // of rounded numbers

inline LoopGroup::LoopGroup(std::vector<const Edge*> closures, const Chain& chain)
    : closures_(std::move(closures)), chain_(chain) {
  const auto size = static_cast<Eigen::Index>(6 * closures_.size());
  of_odometry_ = of_closures_ = Eigen::MatrixXd::Zero(size, size);
  std::vector<Matrix6> to_end;  // from the frame of the first keyframe to that of the loop's end
  for (const Edge* edge : closures_) to_end.push_back(adjoint(chain.poses[edge->to].inverse()));
  for (std::size_t i = 0; i < closures_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(6 * i);
    of_closures_.block<6, 6>(row, row) = closures_[i]->information.inverse();
    for (std::size_t j = 0; j < closures_.size(); ++j) {
      // Loops share the odometry between the later begin and the earlier end.
      const auto [a, b] = std::minmax(closures_[i]->from, closures_[i]->to);
      const auto [c, d] = std::minmax(closures_[j]->from, closures_[j]->to);
      const std::size_t begin = std::max(a, c), end = std::min(b, d);
      if (end <= begin) continue;
      const bool is_against =
          (closures_[i]->from < closures_[i]->to) != (closures_[j]->from < closures_[j]->to);
      of_odometry_.block<6, 6>(row, static_cast<Eigen::Index>(6 * j)) =
          (is_against ? -1.0 : 1.0) * to_end[i] *
          (chain.covariances[end] - chain.covariances[begin]) * to_end[j].transpose();
    }
  }
}

inline Eigen::VectorXd LoopGroup::gaps(const std::vector<Pose>& measured) const {
  Eigen::VectorXd out(static_cast<Eigen::Index>(6 * closures_.size()));
  for (std::size_t i = 0; i < closures_.size(); ++i) {
    out.segment<6>(static_cast<Eigen::Index>(6 * i)) =
        log_se3(measured[i].inverse() * chain_.between(closures_[i]->from, closures_[i]->to));
  }
  return out;
}

inline Eigen::MatrixXd LoopGroup::covariance(const Logarithms& factors) const {
  Eigen::MatrixXd out = std::exp(factors[0]) * of_odometry_ + std::exp(factors[1]) * of_closures_;
  out.diagonal().array() += kLeastVariance;
  return out;
}

/// With a wide prior of the factors: a standard deviation of 6 in the logarithm of the variance.
inline double LoopGroup::log_likelihood_of(const Eigen::VectorXd& values,
                                           const Logarithms& factors) const {
  constexpr double kPrior = 6.0;
  const Eigen::LLT<Eigen::MatrixXd> root(covariance(factors));
  if (root.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
  double out = -root.matrixLLT().diagonal().array().log().sum();
  for (const double factor : factors) out -= 0.5 * factor * factor / (kPrior * kPrior);
  return out - 0.5 * root.matrixL().solve(values).squaredNorm();
}

/// The largest log likelihood found from one start, along each factor in steps that shrink.
inline double LoopGroup::pattern_search(const Eigen::VectorXd& values, Logarithms& at) const {
  double best = log_likelihood_of(values, at);
  for (double step = 4.0; step > 0.4; step *= 0.5) {
    for (bool has_moved = true; has_moved;) {
      has_moved = false;
      for (double& factor : at) {
        for (const double change : {-step, step}) {
          factor += change;
          const double value = log_likelihood_of(values, at);
          if (value > best) {
            best = value;
            has_moved = true;
            break;
          }
          factor -= change;
        }
      }
    }
  }
  return best;
}

/// The part of each gap that the others do not explain.
inline void LoopGroup::add_errors(const Eigen::VectorXd& values,
                                  const Logarithms& factors,
                                  PredictionError& errors) const {
  const Eigen::MatrixXd inverse = covariance(factors).inverse();
  const Eigen::VectorXd weighted = inverse * values;
  for (Eigen::Index i = 0; i < values.size(); i += 6) {
    const Twist error = inverse.block<6, 6>(i, i).ldlt().solve(weighted.segment<6>(i));
    errors.metres.push_back(error.head<3>().norm());
    errors.radians.push_back(error.tail<3>().norm());
  }
}

inline double LoopGroup::log_likelihood(const std::vector<Pose>& measured,
                                        PredictionError* errors) const {
  const Eigen::VectorXd values = gaps(measured);
  Logarithms near{0.0, 0.0}, far{0.0, 4.0};
  const double of_near = pattern_search(values, near), of_far = pattern_search(values, far);
  if (errors != nullptr) add_errors(values, of_near > of_far ? near : far, *errors);
  return std::max(of_near, of_far);
}

}  // namespace loopbench::metrics
