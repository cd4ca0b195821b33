#include "metrics/doctor/graph_repair.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <utility>

namespace loopbench::metrics {
namespace {

/// The same measurement read as `from` in the frame of `to`; its information refers to that frame.
void invert_edge(Edge& edge) {
  const Matrix6 adjoint_of_pose = adjoint(edge.from_from_to.inverse());
  const Matrix6 information = adjoint_of_pose.transpose() * edge.information * adjoint_of_pose;
  edge.information = 0.5 * (information + information.transpose());
  edge.from_from_to = edge.from_from_to.inverse();
}

void exchange_blocks(Edge& edge) {
  const Matrix6 given = edge.information;
  edge.information.topLeftCorner<3, 3>() = given.bottomRightCorner<3, 3>();
  edge.information.bottomRightCorner<3, 3>() = given.topLeftCorner<3, 3>();
  edge.information.topRightCorner<3, 3>() = given.bottomLeftCorner<3, 3>();
  edge.information.bottomLeftCorner<3, 3>() = given.topRightCorner<3, 3>();
}

void multiply(Problem& problem, const InputFinding& finding) {
  for (Edge& edge : problem.odometry) edge.information *= finding.odometry_factor;
  for (std::size_t i = 0; i < problem.closures.size(); ++i) {
    const bool concerns_all = finding.closures.empty();
    if (!concerns_all && !std::ranges::binary_search(finding.closures, i)) continue;
    problem.closures[i].information *= finding.closure_factor;
  }
}

void repair(Problem& problem, const InputFinding& finding) {
  switch (finding.fault) {
    case Fault::closure_direction:
      for (Edge& edge : problem.closures) invert_edge(edge);
      break;
    case Fault::information_order:
      for (auto* edges : {&problem.odometry, &problem.closures}) {
        for (Edge& edge : *edges) exchange_blocks(edge);
      }
      break;
    case Fault::information_scale:
    case Fault::edge_covariance:
      multiply(problem, finding);
      break;
    default:
      break;
  }
}

}  // namespace

void repair(Problem& problem, const std::vector<InputFinding>& findings) {
  for (const InputFinding& finding : findings) repair(problem, finding);
  // Last, because findings refer to closures by their index.
  std::vector<bool> is_false(problem.closures.size(), false);
  for (const InputFinding& finding : findings) {
    if (finding.fault != Fault::closure_gap) continue;
    for (const std::size_t i : finding.closures) is_false[i] = true;
  }
  std::vector<Edge> kept;
  for (std::size_t i = 0; i < is_false.size(); ++i) {
    if (!is_false[i]) kept.push_back(problem.closures[i]);
  }
  problem.closures = std::move(kept);
}

}  // namespace loopbench::metrics
