#include "methods/correctors/unit_of_length.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace loopbench {
namespace {

bool changes_unit(const std::vector<Edge>& edges) {
  return std::ranges::any_of(edges, [](const Edge& edge) { return edge.scale != 1.0; });
}

/// Logarithm of each keyframe's unit over the first one's, as odometry says.
std::vector<double> measured_log_units(const Problem& problem) {
  std::vector<double> out{0.0};
  for (const Edge& edge : problem.odometry) out.push_back(out.back() + std::log(edge.scale));
  return out;
}

/// The same, with the closures' say.
std::vector<double> log_units(const Problem& problem) {
  std::vector<double> out = measured_log_units(problem);
  const std::vector<Edge>& loops = problem.closures;
  const auto size = static_cast<Eigen::Index>(loops.size());
  Eigen::MatrixXd shared = Eigen::MatrixXd::Identity(size, size);
  Eigen::VectorXd gap(size);
  for (std::size_t k = 0; k < loops.size(); ++k) {
    gap[static_cast<Eigen::Index>(k)] =
        std::log(loops[k].scale) - (out[loops[k].to] - out[loops[k].from]);
    for (std::size_t l = 0; l < loops.size(); ++l) {
      const std::size_t begin = std::max(loops[k].from, loops[l].from);
      const std::size_t end = std::min(loops[k].to, loops[l].to);
      if (begin < end) {
        shared(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l)) +=
            static_cast<double>(end - begin);
      }
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(shared);
  if (factor.info() != Eigen::Success) {
    throw std::runtime_error("the equations of the loops' scales are not positive definite");
  }
  const Eigen::VectorXd lambda = factor.solve(gap);
  std::vector<double> change(out.size(), 0.0);  // of what pulls at an edge
  for (std::size_t k = 0; k < loops.size(); ++k) {
    change[loops[k].from] += lambda[static_cast<Eigen::Index>(k)];
    change[loops[k].to] -= lambda[static_cast<Eigen::Index>(k)];
  }
  double pull = 0.0;
  double moved = 0.0;
  for (std::size_t i = 0; i + 1 < out.size(); ++i) {
    pull += change[i];
    moved += pull;
    out[i + 1] += moved;
  }
  return out;
}

Edge measured_in(double unit, Edge edge) {
  edge.from_from_to.translation *= unit;
  Twist shrink = Twist::Ones();
  shrink.head<3>().setConstant(1.0 / unit);
  edge.information = shrink.asDiagonal() * edge.information * shrink.asDiagonal();
  edge.scale = 1.0;
  return edge;
}

}  // namespace

bool changes_unit(const Problem& problem) {
  return changes_unit(problem.odometry) || changes_unit(problem.closures);
}

Problem in_one_unit(const Problem& problem) {
  const std::vector<double> units = log_units(problem);
  Problem out = problem;
  for (std::vector<Edge>* edges : {&out.odometry, &out.closures}) {
    for (Edge& edge : *edges) edge = measured_in(std::exp(units[edge.from]), edge);
  }
  for (const Edge& edge : out.odometry) {
    out.keyframes[edge.to].world_from_body =
        normalized(out.keyframes[edge.from].world_from_body * edge.from_from_to);
  }
  out.frames.clear();  // in units of their own
  return out;
}

}  // namespace loopbench
