#include "metrics/doctor/loop_likelihood.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace loopbench::metrics {
namespace {

/// Logarithms of the three factors.
using Logarithms = std::array<double, 3>;

/// Covariances of the composed odometry that translations and rotations of the steps cause, in the
/// frame of the first keyframe.
std::array<std::vector<Matrix6>, 2> covariances_of_parts(const Chain& chain) {
  const std::vector<Matrix6> zeros(chain.poses.size(), Matrix6::Zero());
  std::array out{zeros, zeros};
  for (std::size_t i = 0; i < chain.steps.size(); ++i) {
    const Matrix6 adjoint_of_pose = adjoint(chain.poses[i + 1]);
    for (int part = 0; part < 2; ++part) {
      const Eigen::Matrix<double, 6, 3> columns = adjoint_of_pose.middleCols<3>(3 * part);
      std::vector<Matrix6>& sums = out[static_cast<std::size_t>(part)];
      sums[i + 1] =
          sums[i] + columns * chain.steps[i].block<3, 3>(3 * part, 3 * part) * columns.transpose();
    }
  }
  return out;
}

/// Gaps of all loops and their covariances for factors of 1.
struct Gaps {
  Eigen::VectorXd values;
  std::array<Eigen::MatrixXd, 3> covariances;  ///< of each part of the noise
};

/// Without the components that are zero in all gaps, as z, roll and pitch of planar graphs.
Gaps without_constants(const Gaps& all) {
  constexpr double kZero = 1e-9;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < all.values.size(); ++i) {
    double largest = 0.0;
    for (Eigen::Index j = i % 6; j < all.values.size(); j += 6) {
      largest = std::max(largest, std::abs(all.values[j]));
    }
    if (largest > kZero) kept.push_back(i);
  }
  Gaps out{all.values(kept), {}};
  for (std::size_t part = 0; part < 3; ++part) {
    out.covariances[part] = all.covariances[part](kept, kept);
  }
  return out;
}

std::array<Eigen::MatrixXd, 3> covariances_of_gaps(const std::vector<Edge>& closures,
                                                   const Chain& chain) {
  const auto size = static_cast<Eigen::Index>(6 * closures.size());
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(size, size);
  std::array out{zero, zero, zero};
  const std::array of_chain = covariances_of_parts(chain);
  std::vector<Matrix6> to_end;  // from the frame of the first keyframe to that of the loop's end
  for (const Edge& edge : closures) to_end.push_back(adjoint(chain.poses[edge.to].inverse()));
  for (std::size_t i = 0; i < closures.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(6 * i);
    out[2].block<6, 6>(row, row) = closures[i].information.inverse();
    for (std::size_t j = 0; j < closures.size(); ++j) {
      const std::size_t begin = std::max(closures[i].from, closures[j].from);
      const std::size_t end = std::min(closures[i].to, closures[j].to);
      if (end <= begin) continue;
      for (std::size_t part = 0; part < 2; ++part) {
        out[part].block<6, 6>(row, static_cast<Eigen::Index>(6 * j)) =
            to_end[i] * (of_chain[part][end] - of_chain[part][begin]) * to_end[j].transpose();
      }
    }
  }
  return out;
}

Eigen::VectorXd gaps_of(const std::vector<Edge>& closures, const Chain& chain, bool inverted) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(6 * closures.size()));
  for (std::size_t i = 0; i < closures.size(); ++i) {
    const Edge& edge = closures[i];
    const Pose measured = inverted ? edge.from_from_to.inverse() : edge.from_from_to;
    out.segment<6>(static_cast<Eigen::Index>(6 * i)) =
        log_se3(measured.inverse() * chain.between(edge.from, edge.to));
  }
  return out;
}

/// With a wide prior of the factors: a standard deviation of 6 in the logarithm of the variance.
double log_likelihood(const Gaps& gaps, const Logarithms& factors) {
  constexpr double kPrior = 6.0;
  Eigen::MatrixXd covariance = std::exp(factors[0]) * gaps.covariances[0];
  double out = 0.0;
  for (std::size_t part = 0; part < 3; ++part) {
    if (part > 0) covariance += std::exp(factors[part]) * gaps.covariances[part];
    out -= 0.5 * factors[part] * factors[part] / (kPrior * kPrior);
  }
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  if (root.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
  out -= root.matrixL().toDenseMatrix().diagonal().array().log().sum();
  return out - 0.5 * root.matrixL().solve(gaps.values).squaredNorm();
}

/// The largest log likelihood found from one start, along each factor in steps that shrink.
double pattern_search(const Gaps& gaps, Logarithms at) {
  double best = log_likelihood(gaps, at);
  for (double step = 4.0; step > 0.4; step *= 0.5) {
    for (bool has_moved = true; has_moved;) {
      has_moved = false;
      for (std::size_t part = 0; part < 3; ++part) {
        for (const double change : {-step, step}) {
          Logarithms next = at;
          next[part] += change;
          const double value = log_likelihood(gaps, next);
          if (!(value > best)) continue;
          best = value;
          at = next;
          has_moved = true;
          break;
        }
      }
    }
  }
  return best;
}

double largest_log_likelihood(const Gaps& gaps) {
  return std::max(pattern_search(gaps, {0.0, 0.0, 0.0}), pattern_search(gaps, {0.0, -4.0, 4.0}));
}

}  // namespace

double inversion_log_ratio(const std::vector<Edge>& closures, const Chain& chain) {
  const auto covariances = covariances_of_gaps(closures, chain);
  const auto likelihood = [&](bool inverted) {
    return largest_log_likelihood(
        without_constants({gaps_of(closures, chain, inverted), covariances}));
  };
  return likelihood(true) - likelihood(false);
}

}  // namespace loopbench::metrics
