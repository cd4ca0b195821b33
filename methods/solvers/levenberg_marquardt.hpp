/// Least squares on a pose graph without loss.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "methods/solvers/normal_equations.hpp"
#include "methods/solvers/pose_graph_solver.hpp"

namespace loopbench::methods {

/// Moves `x`, in the world of pose 0, to the minimum of the cost of solve_pose_graph(). Steps are
/// those of Gauss and Newton as long as the cost decreases as predicted; the damping follows
/// Nielsen, Damping parameter in Marquardt's method, 1999, with the constants of Ceres. It ends
/// when the predicted decrease, which has no cancellation, is below `tolerance`, or below the
/// rounding error of the cost and no longer shrinking. Throws std::runtime_error if the normal
/// equations stay singular.
template <class G>
PoseGraphSummary minimise_least_squares(std::vector<typename G::Element>& x,
                                        const WeightedGraph& graph,
                                        const PoseGraphSettings& settings) {
  constexpr double kLeastRatio = 1e-3;     // of the decrease to the predicted one, to accept a step
  constexpr double kCostRounding = 1e-10;  // relative; long chains have large lever arms
  constexpr double kPoseRounding = 1e-13;  // [rad], and relative to the extent [m]
  constexpr double kMostDamping = 1e16;
  NormalEquations<G> equations(graph, settings);
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

}  // namespace loopbench::methods
