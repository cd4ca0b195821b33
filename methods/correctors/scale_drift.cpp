#include "methods/correctors/scale_drift.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "methods/correctors/looped_chain.hpp"

namespace loopbench::methods {
namespace {

constexpr double kScaleSigma = 0.01;  // deviation of an edge's log scale, as in pose_graph [-]

/// Log scale of each keyframe relative to the first, given the corrections of the edges' log
/// scales.
std::vector<double> log_scales(const Problem& problem, const std::vector<double>& changes) {
  std::vector<double> out{0.0};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    out.push_back(out.back() + std::log(problem.odometry[i].scale) + changes[i]);
  }
  return out;
}

Edge scaled_by(double unit, Edge edge) {
  edge.from_from_to.translation *= unit;
  Twist shrink = Twist::Ones();
  shrink.head<3>().setConstant(1.0 / unit);
  edge.information = shrink.asDiagonal() * edge.information * shrink.asDiagonal();
  edge.scale = 1.0;
  return edge;
}

Problem rigid_with(const Problem& problem, const std::vector<double>& changes) {
  const std::vector<double> units = log_scales(problem, changes);
  Problem out = problem;
  for (std::vector<Edge>* edges : {&out.odometry, &out.closures}) {
    for (Edge& edge : *edges) edge = scaled_by(std::exp(units[edge.from]), edge);
  }
  for (const Edge& edge : out.odometry) {
    out.keyframes[edge.to].world_from_body =
        normalized(out.keyframes[edge.from].world_from_body * edge.from_from_to);
  }
  out.frames.clear();  // their scale is unknown
  return out;
}

/// Log scale errors of the closures, given the corrections of the edges' log scales.
Eigen::VectorXd scale_gaps(const Problem& problem, const std::vector<double>& changes) {
  const std::vector<double> units = log_scales(problem, changes);
  Eigen::VectorXd out(static_cast<Eigen::Index>(problem.closures.size()));
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    const Edge& loop = problem.closures[k];
    out[static_cast<Eigen::Index>(k)] = units[loop.to] - units[loop.from] - std::log(loop.scale);
  }
  return out;
}

/// Jacobian of a closure's seven errors: their change is the sum over its edges of (*this) [q_i; 1]
/// s_i.
using ScaleJacobian = Eigen::Matrix<double, 7, 4>;
using Point = Eigen::Vector4d;

struct ScaleLinearisation {
  std::vector<Point> ends;              ///< [q_i; 1] of each edge, relative to the centroid
  std::vector<ScaleJacobian> closures;  ///< pose, then scale
};

/// Without `jacobian`, only the scale errors are linearised.
ScaleLinearisation linearise_scales(const Problem& rigid,
                                    const Trajectory& at,
                                    const LoopJacobian* jacobian) {
  Vector3 centre = Vector3::Zero();
  for (const StampedPose& k : at) {
    centre += k.world_from_body.translation / static_cast<double>(at.size());
  }
  ScaleLinearisation out;
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    out.ends.emplace_back((at[i + 1].world_from_body.translation - centre).homogeneous());
  }
  for (std::size_t k = 0; k < rigid.closures.size(); ++k) {
    ScaleJacobian one = ScaleJacobian::Zero();
    if (jacobian) {
      Eigen::Matrix<double, 3, 4> lever;
      lever << -Matrix3::Identity(), at[rigid.closures[k].to].world_from_body.translation - centre;
      one.topRows<6>() = jacobian->loop[k].leftCols<3>() * lever;
    }
    one(6, 3) = 1.0;
    out.closures.push_back(one);
  }
  return out;
}

/// Returns the corrections of minimum cost. `gap` holds the closure errors without corrections,
/// seven per closure; `covariance` is their covariance due to the poses.
std::vector<double> min_cost_changes(const ScaleLinearisation& chain,
                                     const LoopSums& sums,
                                     const std::vector<Edge>& closures,
                                     const Eigen::VectorXd& gap,
                                     Eigen::MatrixXd covariance) {
  constexpr double kVariance = kScaleSigma * kScaleSigma;
  const auto running = running_sum(sums, [&](std::size_t i) -> Eigen::Matrix4d {
    return chain.ends[i] * chain.ends[i].transpose();
  });
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(7 * k);
    covariance(row + 6, row + 6) += kVariance;
    for (std::size_t l = 0; l <= k; ++l) {
      if (!sums.overlap(k, l)) continue;
      covariance.block<7, 7>(row, static_cast<Eigen::Index>(7 * l)) +=
          kVariance * chain.closures[k] * sums.over_both(running, k, l) *
          chain.closures[l].transpose();
    }
  }
  const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factor(covariance);
  if (factor.info() != Eigen::Success) {
    throw std::runtime_error("scale drift: the loop equations are not positive definite");
  }
  const Eigen::VectorXd lambda = factor.solve(gap);
  std::vector<Point> begins(chain.ends.size() + 1, Point::Zero());
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const Point pull =
        chain.closures[k].transpose() * lambda.segment<7>(static_cast<Eigen::Index>(7 * k));
    begins[closures[k].from] += pull;
    begins[closures[k].to] -= pull;
  }
  std::vector<double> out;
  Point pull = Point::Zero();
  for (std::size_t e = 0; e < chain.ends.size(); ++e) {
    pull += begins[e];
    out.push_back(-kVariance * pull.dot(chain.ends[e]));
  }
  return out;
}

/// Initial corrections from the scale errors alone, without the poses.
std::vector<double> changes_by_scale(const Problem& problem) {
  const std::size_t loops = problem.closures.size();
  const std::vector<double> none(problem.odometry.size(), 0.0);
  const Eigen::VectorXd scales = scale_gaps(problem, none);
  const auto size = static_cast<Eigen::Index>(7 * loops);
  Eigen::VectorXd gap = Eigen::VectorXd::Zero(size);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(size, size);
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(loops); ++k) {
    gap[7 * k + 6] = scales[k];
    covariance(7 * k + 6, 7 * k + 6) = 0.0;
  }
  return min_cost_changes(linearise_scales(problem, problem.keyframes, nullptr),
                          LoopSums(problem.closures),
                          problem.closures,
                          gap,
                          std::move(covariance));
}

struct ScaleEstimate {
  std::vector<double> changes;
  Problem rigid;
  double cost = 0.0;
  std::vector<double> next;  ///< corrections of minimum cost at this linearisation point
};

/// Minimises the cost over the poses for fixed scales, and linearises the scales there.
ScaleEstimate estimate_at(const Problem& problem, std::vector<double> changes) {
  constexpr int kSteps = 30;
  constexpr double kConverged = 1e-8;  // relative change of the cost
  ScaleEstimate out{std::move(changes), {}, 0.0, {}};
  out.rigid = rigid_with(problem, out.changes);
  const NoiseModel noise_model = stated_noise_model(out.rigid);
  LoopedChain chain(out.rigid, noise_model);
  chain.minimise(kSteps, kConverged);
  const Eigen::VectorXd scales = scale_gaps(problem, out.changes);
  double squares = scales.squaredNorm();
  for (const double change : out.changes) squares += change * change;
  out.cost = chain.cost() + 0.5 * squares / (kScaleSigma * kScaleSigma);

  const LoopJacobian jacobian = chain.linearise();
  const LoopSums& sums = chain.sums();
  const ScaleLinearisation linearisation =
      linearise_scales(out.rigid, chain.keyframes(), &jacobian);
  const Eigen::MatrixXd poses = propagate_covariance(
      jacobian, sums, running_sum(sums, [&](std::size_t i) -> Matrix6 {
        return jacobian.edge[i] * noise_model.covariance[i] * jacobian.edge[i].transpose();
      }));
  const auto running = running_sum(
      sums, [&](std::size_t i) -> Point { return out.changes[i] * linearisation.ends[i]; });
  const auto loops = static_cast<Eigen::Index>(problem.closures.size());
  Eigen::VectorXd gap(7 * loops);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(7 * loops, 7 * loops);
  for (Eigen::Index k = 0; k < loops; ++k) {
    const auto at = static_cast<std::size_t>(k);
    gap.segment<7>(7 * k) << jacobian.gap.segment<6>(6 * k), scales[k];
    gap.segment<7>(7 * k) -= linearisation.closures[at] * sums.over(running, at);
    for (Eigen::Index l = 0; l <= k; ++l) {
      covariance.block<6, 6>(7 * k, 7 * l) = poses.block<6, 6>(6 * k, 6 * l);
    }
    covariance.block<6, 6>(7 * k, 7 * k) += noise_model.closure_covariance[at];
  }
  out.next = min_cost_changes(linearisation, sums, problem.closures, gap, std::move(covariance));
  return out;
}

}  // namespace

bool has_scale_drift(const Problem& problem) {
  const auto scaled = [](const Edge& edge) { return edge.scale != 1.0; };
  return std::ranges::any_of(problem.odometry, scaled) ||
         std::ranges::any_of(problem.closures, scaled);
}

Problem remove_scale_drift(const Problem& problem) {
  constexpr int kMaxIterations = 30;
  constexpr double kConverged = 1e-8;  // relative change of the cost
  constexpr double kMinLength = 0.05;
  ScaleEstimate at = estimate_at(problem, changes_by_scale(problem));
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const double before = at.cost;
    for (double length = 1.0; length > kMinLength; length *= 0.5) {
      std::vector<double> changes = at.changes;
      for (std::size_t i = 0; i < changes.size(); ++i) {
        changes[i] += length * (at.next[i] - changes[i]);
      }
      ScaleEstimate trial = estimate_at(problem, std::move(changes));
      if (trial.cost < at.cost) {
        at = std::move(trial);
        break;
      }
    }
    if (!(before - at.cost > kConverged * before)) break;
  }
  return std::move(at.rigid);
}

}  // namespace loopbench::methods
