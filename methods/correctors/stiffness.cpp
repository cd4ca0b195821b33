#include "methods/correctors/stiffness.hpp"

#include <algorithm>
#include <span>

namespace loopbench::methods {
namespace {

constexpr double kStiffest = 1e6;
constexpr double kStiffSlack = 1.0 + 1e-9;

/// Upper bound on each diagonal entry of a closure's information.
Twist bound_of(std::span<const Edge> odometry) {
  Twist largest = Twist::Zero();
  for (const Edge& edge : odometry) {
    largest = largest.cwiseMax(edge.information.diagonal());
  }
  Twist out;
  out.head<3>().setConstant(kStiffest * largest.head<3>().maxCoeff());
  out.tail<3>().setConstant(kStiffest * largest.tail<3>().maxCoeff());
  return out;
}

}  // namespace

bool is_stiff(const Problem& problem) {
  if (problem.odometry.empty()) return false;
  const std::span<const Edge> odometry(problem.odometry);
  const auto exceeds = [&](const Twist& bound) {
    return std::ranges::any_of(problem.closures, [&](const Edge& closure) {
      return (closure.information.diagonal().array() > kStiffSlack * bound.array()).any();
    });
  };
  // The bound by one edge is at most that by all. If no closure exceeds it, the rest of the
  // odometry, which can be long, need not be read.
  return exceeds(bound_of(odometry.first(1))) && exceeds(bound_of(odometry));
}

Problem with_bounded_stiffness(const Problem& problem) {
  if (problem.odometry.empty()) return problem;
  const Twist bound = bound_of(problem.odometry);
  Problem out = problem;
  for (Edge& closure : out.closures) {
    const Twist shrink = (bound.array() / closure.information.diagonal().array()).min(1.0).sqrt();
    closure.information = shrink.asDiagonal() * closure.information * shrink.asDiagonal();
  }
  return out;
}

}  // namespace loopbench::methods
