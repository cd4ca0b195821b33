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

#include "datasets/core/problem.hpp"

namespace loopbench::metrics {

/// Composed odometry, its length and its covariance to first order.
struct Chain {
  std::vector<Pose> poses;           ///< first_from_keyframe
  std::vector<double> lengths;       ///< up to each keyframe [m]
  std::vector<Matrix6> covariances;  ///< of each pose, as a twist in the frame of the first
  Pose world_from_first;

  Pose in_world(std::size_t keyframe) const { return world_from_first * poses[keyframe]; }

  Pose between(std::size_t i, std::size_t j) const { return poses[i].inverse() * poses[j]; }
  double length(std::size_t i, std::size_t j) const { return std::abs(lengths[j] - lengths[i]); }
};

/// The odometry edges have to be complete. O(keyframes).
inline Chain chain_of(const Problem& problem) {
  Chain out{{Pose{}}, {0.0}, {Matrix6::Zero()}, problem.keyframes.front().world_from_body};
  for (const Edge& step : problem.odometry) {
    out.poses.push_back(normalized(out.poses.back() * step.from_from_to));
    out.lengths.push_back(out.lengths.back() + step.from_from_to.translation.norm());
    const Matrix6 to_first = adjoint(out.poses.back());
    out.covariances.push_back(out.covariances.back() +
                              to_first * step.information.inverse() * to_first.transpose());
  }
  return out;
}

/// Residual of a loop: the end of the odometry along it, in the frame where the closure ends.
inline Pose loop_residual(const Edge& closure, const Chain& chain) {
  return closure.from_from_to.inverse() * chain.between(closure.from, closure.to);
}

inline std::vector<const Edge*> sorted_by_ends(const std::vector<Edge>& closures) {
  std::vector<const Edge*> out;
  for (const Edge& edge : closures) out.push_back(&edge);
  std::ranges::stable_sort(out, {}, [](const Edge* e) { return std::max(e->from, e->to); });
  return out;
}

/// Noise with which the residuals of a group are likeliest.
struct LoopFit {
  std::array<double, 2> factors{};  ///< of the variances of odometry and closures, as logarithms
  double log_likelihood = -std::numeric_limits<double>::infinity();
  /// Errors with which the odometry and the other closures of the group predict each closure.
  std::vector<double> metres = {}, radians = {};
};

/// A few closures with the odometry that their loops share, which explains a part of their
/// residuals together.
class LoopGroup {
 public:
  LoopGroup(std::vector<const Edge*> closures, const Chain& chain)
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

  const std::vector<const Edge*>& closures() const { return closures_; }

  std::vector<Pose> as_read() const {
    std::vector<Pose> out;
    for (const Edge* edge : closures_) out.push_back(edge->from_from_to);
    return out;
  }

  /// The Gaussian log likelihood of the residuals if the closures were `measured`, with the factors
  /// that fit best. O(closures^3).
  LoopFit fit(const std::vector<Pose>& measured) const {
    const Eigen::VectorXd values = residuals(measured);
    LoopFit out;
    // Each kind of edges can explain large residuals.
    for (const Logarithms& start : {Logarithms{0.0, 0.0}, {0.0, 4.0}, {12.0, 0.0}}) {
      LoopFit found = pattern_search(values, start);
      if (found.log_likelihood > out.log_likelihood) out = std::move(found);
    }
    const Eigen::MatrixXd inverse = covariance(out.factors).inverse();
    const Eigen::VectorXd weighted = inverse * values;
    for (Eigen::Index i = 0; i < values.size(); i += 6) {
      const Twist error = inverse.block<6, 6>(i, i).ldlt().solve(weighted.segment<6>(i));
      out.metres.push_back(error.head<3>().norm());
      out.radians.push_back(error.tail<3>().norm());
    }
    return out;
  }

  /// The same as read, with given factors.
  double log_likelihood(const std::array<double, 2>& factors) const {
    return log_likelihood_of(residuals(as_read()), factors);
  }

 private:
  using Logarithms = std::array<double, 2>;

  Eigen::VectorXd residuals(const std::vector<Pose>& measured) const {
    Eigen::VectorXd out(static_cast<Eigen::Index>(6 * closures_.size()));
    for (std::size_t i = 0; i < closures_.size(); ++i) {
      out.segment<6>(static_cast<Eigen::Index>(6 * i)) =
          log_se3(measured[i].inverse() * chain_.between(closures_[i]->from, closures_[i]->to));
    }
    return out;
  }

  Eigen::MatrixXd covariance(const Logarithms& factors) const {
    constexpr double kLeastVariance = 1e-12;  // of rounded numbers
    Eigen::MatrixXd out = std::exp(factors[0]) * of_odometry_ + std::exp(factors[1]) * of_closures_;
    out.diagonal().array() += kLeastVariance;
    return out;
  }

  /// With a wide prior of the factors: a standard deviation of 6 in the logarithm of the variance.
  double log_likelihood_of(const Eigen::VectorXd& values, const Logarithms& factors) const {
    constexpr double kPrior = 6.0;
    const Eigen::LLT<Eigen::MatrixXd> root(covariance(factors));
    if (root.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
    double out = -root.matrixLLT().diagonal().array().log().sum();
    for (const double factor : factors) out -= 0.5 * factor * factor / (kPrior * kPrior);
    return out - 0.5 * root.matrixL().solve(values).squaredNorm();
  }

  /// The largest log likelihood found from one start, along each factor in steps that shrink.
  LoopFit pattern_search(const Eigen::VectorXd& values, Logarithms at) const {
    double best = log_likelihood_of(values, at);
    for (double step = 4.0; step > 0.4; step *= 0.5) {
      for (bool has_moved = true; has_moved;) {
        has_moved = false;
        for (const auto& [kind, change] :
             {std::pair{0u, -step}, {0u, step}, {1u, -step}, {1u, step}}) {
          Logarithms to = at;
          to[kind] += change;
          const double value = log_likelihood_of(values, to);
          if (!(value > best)) continue;
          best = value;
          at = to;
          has_moved = true;
        }
      }
    }
    return {at, best};
  }

  std::vector<const Edge*> closures_;
  const Chain& chain_;
  Eigen::MatrixXd of_odometry_, of_closures_;  ///< covariances as stated
};

/// At most 14 groups of up to `most` different closures that follow each other, evenly chosen.
inline std::vector<LoopGroup> loop_groups(const std::vector<Edge>& closures,
                                          const Chain& chain,
                                          std::size_t most = 5) {
  constexpr std::size_t kMostGroups = 14;
  std::vector<const Edge*> sorted = sorted_by_ends(closures);
  // A closure that is listed twice has the same error, which does not show how large errors are.
  const auto is_copy = [](const Edge* a, const Edge* b) {
    return a->from == b->from && a->to == b->to &&
           is_close(a->from_from_to, b->from_from_to, 1e-9, 1e-9);
  };
  sorted.erase(std::unique(sorted.begin(), sorted.end(), is_copy), sorted.end());
  const std::size_t n = sorted.size();
  const std::size_t count =
      std::min({kMostGroups, n, std::max<std::size_t>((n + 1) / most, n > most ? 2 : 1)});
  std::vector<LoopGroup> out;
  for (std::size_t i = 0; i < count; ++i) {
    const auto begin = sorted.begin() + static_cast<std::ptrdiff_t>(i * n / count);
    const auto end = sorted.begin() + static_cast<std::ptrdiff_t>((i + 1) * n / count);
    out.emplace_back(
        std::vector<const Edge*>(begin, std::min(end, begin + static_cast<std::ptrdiff_t>(most))),
        chain);
  }
  return out;
}

/// Gain in log likelihood. One group, whose closures may be false, counts up to a limit.
inline double gain(const std::vector<LoopFit>& before, const std::vector<LoopFit>& after) {
  constexpr double kMostOfGroup = 20.0;
  double out = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double of_group = after[i].log_likelihood - before[i].log_likelihood;
    out += std::clamp(of_group, -kMostOfGroup, kMostOfGroup);
  }
  return out;
}

}  // namespace loopbench::metrics
