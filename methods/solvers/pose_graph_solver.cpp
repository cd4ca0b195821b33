#include "methods/solvers/pose_graph_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "methods/solvers/ceres_minimiser.hpp"
#include "methods/solvers/groups/visit_group.hpp"
#include "methods/solvers/normal_equations.hpp"

namespace loopbench::methods {
namespace {

/// Moves `x`, in the world of pose 0, to the minimum of the cost of solve_pose_graph(). Steps are
/// those of Gauss and Newton as long as the cost decreases as predicted; the damping follows
/// Nielsen, Damping parameter in Marquardt's method, 1999, with the constants of Ceres. It ends
/// when the predicted decrease, which has no cancellation, is below `tolerance`, or below the
/// rounding error of the cost and no longer shrinking. Throws std::runtime_error if the normal
/// equations stay singular.
template <class G>
PoseGraphSummary minimise_least_squares(std::vector<typename G::Element>& x,
                                        const WeightedEdges& edges,
                                        const PoseGraphSettings& settings,
                                        EliminationCache& cache) {
  constexpr double kLeastRatio = 1e-3;     // of the decrease to the predicted one, to accept a step
  constexpr double kCostRounding = 1e-10;  // relative; long chains have large lever arms
  constexpr double kPoseRounding = 1e-13;  // [rad], and relative to the extent [m]
  constexpr double kMostDamping = 1e16;
  NormalEquations<G> equations(x.size(), edges, settings, cache);
  typename NormalEquations<G>::Step step;
  std::vector<typename G::Element> candidate = x;
  double extent = 1.0;
  for (const auto& each : x) {
    extent = std::max(extent, G::to_scaled_pose(each).pose.translation.norm());
  }
  // Long chains have directions with 1e-9 of the stiffness of their diagonal, along which a larger
  // damping converges very slowly.
  double damping = 1e-12;
  double growth = 2.0;
  double cost = equations.linearise(x);
  double last_predicted = std::numeric_limits<double>::infinity();
  PoseGraphSummary out{0, cost, cost, false};
  if (!std::isfinite(cost)) throw std::runtime_error("pose graph: the initial cost is not finite");
  while (out.iterations < settings.max_iterations && !out.converged) {
    ++out.iterations;
    const auto damp_more = [&] {
      damping *= growth;
      growth *= 2.0;
      if (damping > kMostDamping) {
        throw std::runtime_error("pose graph: the normal equations are singular");
      }
      equations.linearise(x);
    };
    if (!equations.solve(damping, step)) {
      damp_more();
      continue;
    }
    const double predicted = step.predicted_decrease;
    if (step.values.cwiseAbs().maxCoeff() <= kPoseRounding * extent) {
      out.converged = true;
      break;
    }
    for (std::size_t i = equations.first(); i < x.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i - equations.first()) * G::kDof;
      candidate[i] = G::compose(x[i], G::exp(step.values.template segment<G::kDof>(row)));
    }
    out.converged = predicted <= settings.tolerance * cost;
    const double next = out.converged ? equations.cost(candidate) : equations.linearise(candidate);
    const double ratio = (cost - next) / predicted;
    if (ratio > kLeastRatio) {
      out.converged = out.converged || cost - next <= settings.tolerance * cost;
      damping *= std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * ratio - 1.0, 3));
      growth = 2.0;
    } else if (next - cost <= kCostRounding * cost) {
      // The cost is flat to its rounding error, but the poses may not have converged: 1e-12 of it
      // is a tenth of a millimetre on long chains.
      if (predicted >= last_predicted) out.converged = true;
    } else {
      out.converged = predicted <= settings.tolerance * cost;  // no step was taken
      last_predicted = std::numeric_limits<double>::infinity();
      if (!out.converged) damp_more();
      continue;
    }
    std::swap(x, candidate);
    cost = next;
    last_predicted = predicted;
  }
  out.cost = cost;
  return out;
}

/// The anchor in the world of pose 0.
Anchor relative_to(const Pose& world_from_first, Anchor anchor) {
  const Matrix3 R = world_from_first.rotation.toRotationMatrix();
  anchor.position = world_from_first.inverse() * anchor.position;
  anchor.covariance = R.transpose() * anchor.covariance * R;
  return anchor;
}

/// Poses are expressed relative to pose 0: a large distance from the world origin costs no
/// precision, and the motion plane need not be horizontal in the world.
template <class G>
PoseGraphSummary solve_in(std::vector<ScaledPose>& poses,
                          const WeightedEdges& edges,
                          PoseGraphSettings settings,
                          EliminationCache& cache) {
  const ScaledPose world_from_first = poses.front();
  const ScaledPose first_from_world = world_from_first.inverse();
  std::vector<typename G::Element> x;
  x.reserve(poses.size());
  for (const ScaledPose& pose : poses) x.push_back(G::from(first_from_world * pose));
  for (Anchor& anchor : settings.anchors) anchor = relative_to(world_from_first.pose, anchor);
  // Ceres has the corrections of the curvature that robust losses need.
  const PoseGraphSummary summary = settings.loss == RobustLoss::none
                                       ? minimise_least_squares<G>(x, edges, settings, cache)
                                       : minimise_with_ceres<G>(x, edges, settings);
  for (std::size_t i = settings.is_first_free ? 0 : 1; i < poses.size(); ++i) {
    poses[i] = normalized(world_from_first * G::to_scaled_pose(x[i]));
  }
  return summary;
}

template <class G>
std::vector<double> squared_in(const std::vector<ScaledPose>& poses,
                               const std::vector<Edge>& edges,
                               double scale_sigma) {
  std::vector<double> out;
  out.reserve(edges.size());
  const ScaledPose first_from_world = poses.front().inverse();
  const auto relative_pose = [&](std::size_t i) { return G::from(first_from_world * poses[i]); };
  for (const Edge& edge : edges) {
    const auto back = G::inverse(G::from(measured(edge)));
    const auto from_from_to =
        G::compose(G::inverse(relative_pose(edge.from)), relative_pose(edge.to));
    const typename G::Tangent e = group_edge_error<G>(back, from_from_to);
    out.push_back(e.dot(G::information(edge, scale_sigma) * e));
  }
  return out;
}

}  // namespace

PoseGraphSummary solve_pose_graph(std::vector<ScaledPose>& poses,
                                  const WeightedEdges& edges,
                                  const PoseGraphSettings& settings,
                                  EliminationCache& cache) {
  if (poses.empty()) return {};
  return visit_group(settings.group,
                     [&]<class G>(G) { return solve_in<G>(poses, edges, settings, cache); });
}

std::vector<double> squared_errors(const std::vector<ScaledPose>& poses,
                                   const std::vector<Edge>& edges,
                                   const PoseGraphSettings& settings) {
  if (edges.empty()) return {};
  return visit_group(settings.group,
                     [&]<class G>(G) { return squared_in<G>(poses, edges, settings.scale_sigma); });
}

double loss_derivative(const PoseGraphSettings& settings, double squared) {
  const double width = settings.loss_width;
  const double s = width / (width + squared);
  switch (settings.loss) {
    case RobustLoss::none:
      return 1.0;
    case RobustLoss::huber:
      return squared <= width ? 1.0 : std::sqrt(width / squared);
    case RobustLoss::cauchy:
      return s;
    case RobustLoss::dcs:
      return std::min(1.0, 4.0 * s * s);
  }
  return 1.0;
}

}  // namespace loopbench::methods
