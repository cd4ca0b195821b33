/// Step 5: psi, the "optimal tangent vector" among candidates psi_1..psi_i.
///
/// The article defines neither the candidates, nor the cost, nor the use. psi does not change
/// orientations.
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <span>

#include "methods/smoothers/manifold/spline.hpp"

namespace loopbench::methods::manifold {

/// Use of psi: none, or as the spline's direction at the ends of segments.
enum class PsiUse { none, boundary_tangent };
inline auto choices(PsiUse) {
  return std::array{std::pair{"none", PsiUse::none},
                    std::pair{"boundary_tangent", PsiUse::boundary_tangent}};
}

/// discrete: the best of the candidates. frechet: the Frechet mean of the chords on the sphere.
enum class PsiMean { discrete, frechet };
inline auto choices(PsiMean) {
  return std::array{std::pair{"discrete", PsiMean::discrete},
                    std::pair{"frechet", PsiMean::frechet}};
}

/// Unit direction and its weight.
struct WeightedDirection {
  Vector3 direction;
  double weight;
};

inline constexpr double kDecayTime = 1.0;  // [s]

inline void add(std::vector<Vector3>& out, const Vector3& direction, const Vector3& displacement) {
  if (!(direction.norm() > 0.0)) return;
  const Vector3 unit = direction.normalized();
  out.push_back(unit.dot(displacement) < 0.0 ? Vector3(-unit) : unit);
}

inline NodeRange neighbourhood(const Nodes& nodes, std::size_t node, std::size_t half) {
  return {node - std::min(node, half), std::min(node + half, nodes.size() - 1)};
}

inline Vector3 principal_axis(const Nodes& nodes, NodeRange range) {
  Vector3 mean = Vector3::Zero();
  for (std::size_t i = range.first; i <= range.last; ++i) mean += nodes.points[i];
  mean /= static_cast<double>(range.nodes());
  Matrix3 covariance = Matrix3::Zero();
  for (std::size_t i = range.first; i <= range.last; ++i) {
    covariance += (nodes.points[i] - mean) * (nodes.points[i] - mean).transpose();
  }
  if (!(covariance.trace() > 0.0)) return Vector3::Zero();
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(covariance);
  return solver.eigenvectors().col(2);
}

/// Weighted sum of squared angles to the directions [rad^2].
inline double dispersion(const Vector3& psi, std::span<const WeightedDirection> chords) {
  double sum = 0.0;
  for (const auto& [direction, weight] : chords) {
    const double angle = angle_between_directions(psi, direction);
    sum += weight * angle * angle;
  }
  return sum;
}

/// Returns the unit vector that minimises dispersion(): five steps of gradient descent on the
/// sphere (Karcher, step size 1) from the weighted sum. It is unique for directions within an open
/// hemisphere.
inline Vector3 frechet_mean(std::span<const WeightedDirection> directions) {
  Vector3 mean = Vector3::Zero();
  double weights = 0.0;
  for (const auto& [direction, weight] : directions) {
    mean += weight * direction;
    weights += weight;
  }
  if (!(mean.norm() > 0.0)) return Vector3::Zero();
  mean.normalize();
  for (int step = 0; step < 5; ++step) {
    Vector3 update = Vector3::Zero();  // mean of the logarithms, in the tangent plane
    for (const auto& [direction, weight] : directions) {
      const Vector3 perpendicular = direction - mean.dot(direction) * mean;
      if (perpendicular.norm() > 0.0)
        update += weight * angle_between_directions(mean, direction) * perpendicular.normalized();
    }
    update /= weights;
    const double angle = update.norm();
    if (!(angle > 0.0)) break;
    mean = (std::cos(angle) * mean + std::sin(angle) / angle * update).normalized();
  }
  return mean;
}

/// Chords around a node, up to `half` steps on each side, with the weight exp(-|t| / 1 s), where t
/// is the time from the node to the middle of the chord. Steps of zero length are omitted.
inline std::vector<WeightedDirection> chords_around(const Nodes& nodes,
                                                    std::size_t node,
                                                    std::size_t half) {
  std::vector<WeightedDirection> out;
  const NodeRange range = neighbourhood(nodes, node, half);
  for (std::size_t edge = range.first; edge < range.last; ++edge) {
    const double middle = 0.5 * (nodes.stamps[edge] + nodes.stamps[edge + 1]);
    const Vector3 step = nodes.step(edge);
    if (!(step.norm() > 0.0)) continue;
    out.push_back(
        {step.normalized(), std::exp(-std::abs(middle - nodes.stamps[node]) / kDecayTime)});
  }
  return out;
}

/// Candidate directions: backward, forward and central chord, principal axis of the surrounding
/// nodes, and tangent of the spline. Unit vectors, oriented along the displacement. Undefined
/// directions are omitted.
inline std::vector<Vector3> candidates(const Nodes& nodes,
                                       const NodeSpline& spline,
                                       std::size_t node,
                                       std::size_t half) {
  const NodeRange near = neighbourhood(nodes, node, 1);
  const NodeRange wide = neighbourhood(nodes, node, half);
  const Vector3 displacement = nodes.points[wide.last] - nodes.points[wide.first];
  std::vector<Vector3> out;
  add(out, nodes.points[node] - nodes.points[near.first], displacement);
  add(out, nodes.points[near.last] - nodes.points[node], displacement);
  add(out, nodes.points[near.last] - nodes.points[near.first], displacement);
  add(out, principal_axis(nodes, wide), displacement);
  const std::size_t edge = std::min(node, nodes.size() - 2);
  add(out, spline.at(edge, time_jet(nodes.stamps[node])).point.first, displacement);
  return out;
}

/// psi at a node; the zero vector where all surrounding nodes are at rest.
inline Vector3 optimal_tangent(const Nodes& nodes,
                               const NodeSpline& spline,
                               std::size_t node,
                               std::size_t half,
                               PsiMean mean) {
  const auto chords = chords_around(nodes, node, half);
  if (chords.empty()) return Vector3::Zero();
  if (mean == PsiMean::frechet) return frechet_mean(chords);
  const auto all = candidates(nodes, spline, node, half);
  if (all.empty()) return Vector3::Zero();
  return *std::min_element(all.begin(), all.end(), [&](const Vector3& a, const Vector3& b) {
    return dispersion(a, chords) < dispersion(b, chords);
  });
}

/// Velocities at the ends of segments: psi times the mean speed over the two adjacent steps.
/// O(nodes).
inline std::vector<Clamp> segment_end_velocities(const Nodes& nodes,
                                                 const NodeSpline& spline,
                                                 std::span<const NodeRange> segments,
                                                 std::size_t half,
                                                 PsiMean mean) {
  std::vector<Clamp> out;
  const auto clamp = [&](std::size_t node) {
    const NodeRange near = neighbourhood(nodes, node, 1);
    double length = 0.0;
    for (std::size_t edge = near.first; edge < near.last; ++edge) length += nodes.step(edge).norm();
    const double speed = length / (nodes.stamps[near.last] - nodes.stamps[near.first]);
    out.push_back({node, speed * optimal_tangent(nodes, spline, node, half, mean)});
  };
  clamp(segments.front().first);
  for (const NodeRange& segment : segments) clamp(segment.last);
  return out;
}

}  // namespace loopbench::methods::manifold
