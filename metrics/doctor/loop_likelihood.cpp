#include "metrics/doctor/loop_likelihood.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace loopbench::metrics {
namespace {

constexpr double kZero = 1e-9;            // gaps below are zero [m], [rad]
constexpr double kLeastVariance = 1e-12;  // of rounded numbers

Eigen::VectorXd all_gaps(const std::vector<const Edge*>& closures,
                         const Chain& chain,
                         const std::vector<Pose>& measured) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(6 * closures.size()));
  for (std::size_t i = 0; i < closures.size(); ++i) {
    out.segment<6>(static_cast<Eigen::Index>(6 * i)) =
        log_se3(measured[i].inverse() * chain.between(closures[i]->from, closures[i]->to));
  }
  return out;
}

}  // namespace

StepCovariances step_covariances(const Chain& chain) {
  const std::vector<Matrix6> zeros(chain.poses.size(), Matrix6::Zero());
  StepCovariances out{zeros, zeros};
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

LoopGroup::LoopGroup(std::vector<const Edge*> closures,
                     const Chain& chain,
                     const StepCovariances& noise)
    : closures_(std::move(closures)), chain_(chain) {
  const auto size = static_cast<Eigen::Index>(6 * closures_.size());
  covariances_.fill(Eigen::MatrixXd::Zero(size, size));
  std::vector<Matrix6> to_end;  // from the frame of the first keyframe to that of the loop's end
  std::vector<Pose> as_read;
  for (const Edge* edge : closures_) {
    to_end.push_back(adjoint(chain.poses[edge->to].inverse()));
    as_read.push_back(edge->from_from_to);
  }
  for (std::size_t i = 0; i < closures_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(6 * i);
    const Matrix6 stated = closures_[i]->information.inverse();
    covariances_[2].block<3, 3>(row, row) = stated.topLeftCorner<3, 3>();
    covariances_[3].block<3, 3>(row + 3, row + 3) = stated.bottomRightCorner<3, 3>();
    for (std::size_t j = 0; j < closures_.size(); ++j) {
      // Loops share the odometry between the later begin and the earlier end.
      const auto [a, b] = std::minmax(closures_[i]->from, closures_[i]->to);
      const auto [c, d] = std::minmax(closures_[j]->from, closures_[j]->to);
      const std::size_t begin = std::max(a, c), end = std::min(b, d);
      if (end <= begin) continue;
      const bool is_against =
          (closures_[i]->from < closures_[i]->to) != (closures_[j]->from < closures_[j]->to);
      for (std::size_t part = 0; part < 2; ++part) {
        covariances_[part].block<6, 6>(row, static_cast<Eigen::Index>(6 * j)) =
            (is_against ? -1.0 : 1.0) * to_end[i] * (noise[part][end] - noise[part][begin]) *
            to_end[j].transpose();
      }
    }
  }
  const Eigen::VectorXd values = all_gaps(closures_, chain_, as_read);
  for (Eigen::Index component = 0; component < 6; ++component) {
    double largest = 0.0;
    for (Eigen::Index i = component; i < size; i += 6) {
      largest = std::max(largest, std::abs(values[i]));
    }
    if (largest <= kZero) continue;
    (component < 3 ? translations_ : rotations_) += 1.0;
    for (Eigen::Index i = component; i < size; i += 6) kept_.push_back(i);
  }
  std::ranges::sort(kept_);
  for (Eigen::MatrixXd& each : covariances_) each = Eigen::MatrixXd(each(kept_, kept_));
}

Eigen::VectorXd LoopGroup::gaps(const std::vector<Pose>& measured) const {
  const Eigen::VectorXd all = all_gaps(closures_, chain_, measured);
  const Eigen::VectorXd kept = all(kept_);
  constexpr double kMostOutside = 1e-6;
  if (all.squaredNorm() - kept.squaredNorm() > kMostOutside) return {};
  return kept;
}

Eigen::MatrixXd LoopGroup::covariance(const Logarithms& factors) const {
  Eigen::MatrixXd out = std::exp(factors[0]) * covariances_[0];
  for (std::size_t part = 1; part < 4; ++part) out += std::exp(factors[part]) * covariances_[part];
  out.diagonal().array() += kLeastVariance;
  return out;
}

/// With a wide prior of the factors: a standard deviation of 6 in the logarithm of the variance.
double LoopGroup::log_likelihood_of(const Eigen::VectorXd& values,
                                    const Logarithms& factors) const {
  constexpr double kPrior = 6.0;
  const Eigen::LLT<Eigen::MatrixXd> root(covariance(factors));
  if (root.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
  double out = -root.matrixLLT().diagonal().array().log().sum();
  for (const double factor : factors) out -= 0.5 * factor * factor / (kPrior * kPrior);
  return out - 0.5 * root.matrixL().solve(values).squaredNorm();
}

/// The largest log likelihood found from one start, along each factor in steps that shrink.
double LoopGroup::pattern_search(const Eigen::VectorXd& values, Logarithms& at) const {
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
void LoopGroup::add_errors(const Eigen::VectorXd& values,
                           const Logarithms& factors,
                           PredictionError& errors) const {
  const Eigen::MatrixXd inverse = covariance(factors).inverse();
  const Eigen::VectorXd weighted = inverse * values;
  const auto size = static_cast<Eigen::Index>(kept_.size() / closures_.size());
  const auto metres = static_cast<Eigen::Index>(translations_);
  for (Eigen::Index i = 0; i < values.size(); i += size) {
    const Eigen::VectorXd error =
        inverse.block(i, i, size, size).ldlt().solve(weighted.segment(i, size));
    errors.metres.push_back(error.head(metres).norm());
    errors.radians.push_back(error.tail(size - metres).norm());
  }
}

double LoopGroup::log_likelihood(const std::vector<Pose>& measured, PredictionError* errors) const {
  const Eigen::VectorXd values = gaps(measured);
  if (kept_.empty()) return 0.0;
  if (values.size() == 0) return -std::numeric_limits<double>::infinity();
  Logarithms near{0.0, 0.0, 0.0, 0.0}, far{0.0, -4.0, 4.0, 4.0};
  const double of_near = pattern_search(values, near), of_far = pattern_search(values, far);
  if (errors != nullptr) add_errors(values, of_near > of_far ? near : far, *errors);
  return std::max(of_near, of_far);
}

}  // namespace loopbench::metrics
