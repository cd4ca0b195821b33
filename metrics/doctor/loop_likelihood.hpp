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

  /// Logarithms of the factors for odometry and closures.
  using Logarithms = std::array<double, 2>;

  /// The factors that fit best to the closures as they are. O(closures^3).
  Logarithms best_factors() const;

  /// The same likelihood of the closures as they are, with given factors. O(closures^3).
  double log_likelihood_of(const Logarithms& factors) const;

 private:
  std::vector<Pose> as_read() const;
  Eigen::VectorXd gaps(const std::vector<Pose>& measured) const;
  std::pair<double, Logarithms> best_of(const Eigen::VectorXd& values) const;
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

inline constexpr double kLeastVariance = 1e-16;  // of rounded numbers

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

inline std::pair<double, LoopGroup::Logarithms> LoopGroup::best_of(
    const Eigen::VectorXd& values) const {
  std::pair<double, Logarithms> best{-std::numeric_limits<double>::infinity(), {}};
  for (Logarithms at : {Logarithms{0.0, 0.0}, Logarithms{0.0, 4.0}, Logarithms{10.0, 0.0}}) {
    const double found = pattern_search(values, at);
    if (found > best.first) best = {found, at};
  }
  return best;
}

inline double LoopGroup::log_likelihood(const std::vector<Pose>& measured,
                                        PredictionError* errors) const {
  const Eigen::VectorXd values = gaps(measured);
  const auto [likelihood, factors] = best_of(values);
  if (errors != nullptr) add_errors(values, factors, *errors);
  return likelihood;
}

inline std::vector<Pose> LoopGroup::as_read() const {
  std::vector<Pose> out;
  for (const Edge* edge : closures_) out.push_back(edge->from_from_to);
  return out;
}

inline LoopGroup::Logarithms LoopGroup::best_factors() const {
  return best_of(gaps(as_read())).second;
}

inline double LoopGroup::log_likelihood_of(const Logarithms& factors) const {
  return log_likelihood_of(gaps(as_read()), factors);
}

/// The same edge again has the same error, so the two do not show how large errors are.
inline bool is_copy(const Edge* a, const Edge* b) {
  return a->from == b->from && a->to == b->to &&
         a->from_from_to.translation == b->from_from_to.translation &&
         a->from_from_to.rotation.coeffs() == b->from_from_to.rotation.coeffs();
}

/// Groups of up to five different closures that follow each other, evenly chosen.
inline std::vector<LoopGroup> groups_of(const std::vector<Edge>& closures, const Chain& chain) {
  constexpr std::size_t kSize = 5, kMost = 14;
  std::vector<const Edge*> sorted = sorted_by_end(closures);
  sorted.erase(std::unique(sorted.begin(), sorted.end(), is_copy), sorted.end());
  const std::size_t n = sorted.size();
  const std::size_t count = std::clamp<std::size_t>((n + 1) / kSize, n < kSize + 1 ? 1 : 2, kMost);
  std::vector<LoopGroup> out;
  for (std::size_t i = 0; i < count; ++i) {
    const auto begin = sorted.begin() + static_cast<std::ptrdiff_t>(i * n / count);
    const std::size_t size = (i + 1) * n / count - i * n / count;
    const auto end = begin + static_cast<std::ptrdiff_t>(count == 1 ? n : std::min(size, kSize));
    out.emplace_back(std::vector<const Edge*>(begin, end), chain);
  }
  return out;
}

/// Choices and proofs use alternate groups; all, if there are few, which differ little by chance.
inline std::size_t step_of(const std::vector<LoopGroup>& groups) {
  constexpr std::size_t kFewestForHalves = 6;
  return groups.size() < kFewestForHalves ? 1 : 2;
}

}  // namespace loopbench::metrics
