#include "metrics/doctor/closure_chain.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "metrics/doctor/common_motion.hpp"

namespace loopbench::metrics {
namespace {

std::size_t difference(std::size_t i, std::size_t j) { return i > j ? i - j : j - i; }

Matrix6 exchanged_blocks(const Matrix6& given) {
  Matrix6 out = Matrix6::Zero();
  out.topLeftCorner<3, 3>() = given.bottomRightCorner<3, 3>();
  out.bottomRightCorner<3, 3>() = given.topLeftCorner<3, 3>();
  return out;
}

Matrix6 moved(const Pose& pose, const Matrix6& covariance) {
  const Matrix6 a = adjoint(pose);
  return a * covariance * a.transpose();
}

/// The same edge again has the same error, so the two do not show how large errors are.
bool is_copy(const Edge& a, const Edge& b) {
  return a.from == b.from && a.to == b.to &&
         a.from_from_to.translation == b.from_from_to.translation &&
         a.from_from_to.rotation.coeffs() == b.from_from_to.rotation.coeffs();
}

/// Parts without valid information count as 0: they constrain nothing.
SquaredError over(const Twist& residual, const Matrix6& covariance) {
  const auto valid = [](double x) { return std::isfinite(x) && x > 0.0 ? x : 0.0; };
  return {valid(residual.head<3>().squaredNorm() / covariance.topLeftCorner<3, 3>().trace()),
          valid(residual.tail<3>().squaredNorm() / covariance.bottomRightCorner<3, 3>().trace()),
          valid(residual.dot(covariance.ldlt().solve(residual)) / 6.0)};
}

}  // namespace

double Chain::length(std::size_t i, std::size_t j) const {
  return std::abs(lengths[j] - lengths[i]);
}

Matrix6 Chain::covariance(std::size_t i, std::size_t j) const {
  return moved(poses[j].inverse(), covariances[std::max(i, j)] - covariances[std::min(i, j)]);
}

Chain chain_of(const Problem& problem) {
  const std::size_t size = problem.keyframes.size();
  Chain out{std::vector<Pose>(size),
            std::vector<double>(size, 0.0),
            std::vector<Matrix6>(size, Matrix6::Zero()),
            {}};
  for (std::size_t i = 0; i + 1 < size && i < problem.odometry.size(); ++i) {
    const Edge& step = problem.odometry[i];
    out.poses[i + 1] = normalized(out.poses[i] * step.from_from_to);
    out.lengths[i + 1] = out.lengths[i] + step.from_from_to.translation.norm();
    out.steps.push_back(step.information.inverse());
    out.covariances[i + 1] = out.covariances[i] + moved(out.poses[i + 1], out.steps[i]);
  }
  return out;
}

Chain exchanged(const Chain& chain) {
  Chain out = chain;
  for (std::size_t i = 0; i < out.steps.size(); ++i) {
    out.steps[i] = exchanged_blocks(chain.steps[i]);
    out.covariances[i + 1] = out.covariances[i] + moved(out.poses[i + 1], out.steps[i]);
  }
  return out;
}

SquaredError closure_error(const Edge& closure, const Chain& chain, bool is_exchanged) {
  const Twist gap =
      log_se3(closure.from_from_to.inverse() * chain.between(closure.from, closure.to));
  const Matrix6 stated = closure.information.inverse();
  return over(gap,
              (is_exchanged ? exchanged_blocks(stated) : stated) +
                  chain.covariance(closure.from, closure.to));
}

double gap_of(const Edge& closure, const Chain& chain) {
  const Pose gap = closure.from_from_to.inverse() * chain.between(closure.from, closure.to);
  return gap.translation.norm();
}

SquaredError median_error(const std::vector<SquaredError>& all) {
  const auto median_of = [&](double SquaredError::*part) {
    std::vector<double> values;
    for (const SquaredError& each : all) values.push_back(each.*part);
    return median_value(std::move(values));
  };
  return {median_of(&SquaredError::translation),
          median_of(&SquaredError::rotation),
          median_of(&SquaredError::whole)};
}

std::vector<Neighbours> neighbours_of(const std::vector<Edge>& closures, const Chain& chain) {
  constexpr std::size_t kSearched = 12, kMostKeyframes = 15;
  constexpr double kMostMetres = 15.0;
  std::vector<Neighbours> out;
  for (std::size_t i = 0; i < closures.size(); ++i) {
    for (std::size_t j = i + 1; j < std::min(closures.size(), i + 1 + kSearched); ++j) {
      const Edge& a = closures[i];
      const Edge& b = closures[j];
      if (is_copy(a, b)) continue;
      const bool is_near = difference(a.from, b.from) <= kMostKeyframes &&
                           difference(a.to, b.to) <= kMostKeyframes &&
                           chain.length(a.from, b.from) <= kMostMetres &&
                           chain.length(a.to, b.to) <= kMostMetres;
      if (is_near) {
        out.push_back({&a, &b});
        break;
      }
    }
  }
  return out;
}

Twist neighbour_residual(const Neighbours& pair, const Chain& chain) {
  const Pose around = chain.between(pair.a->from, pair.b->from) * pair.b->from_from_to *
                      chain.between(pair.b->to, pair.a->to);
  return log_se3(pair.a->from_from_to.inverse() * around);
}

namespace {

SquaredError neighbour_error(const Neighbours& pair, const Chain& chain) {
  const auto& [a, b] = pair;
  const Pose to_a_from_b = chain.between(a->to, b->to);  // frames at the ends of both closures
  const Pose end_from_start = (b->from_from_to * to_a_from_b.inverse()).inverse();
  const Matrix6 covariance =
      a->information.inverse() + moved(to_a_from_b, b->information.inverse()) +
      chain.covariance(b->to, a->to) + moved(end_from_start, chain.covariance(a->from, b->from));
  return over(neighbour_residual(pair, chain), covariance);
}

}  // namespace

std::vector<SquaredError> neighbour_errors(const std::vector<Neighbours>& pairs,
                                           const Chain& chain) {
  std::vector<SquaredError> out;
  for (const Neighbours& pair : pairs) out.push_back(neighbour_error(pair, chain));
  return out;
}

}  // namespace loopbench::metrics
