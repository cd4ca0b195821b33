#include "methods/correctors/stiffness.hpp"

#include <algorithm>
#include <cmath>

namespace loopbench::methods {
namespace {

constexpr double kStiffest = 1e6;
constexpr double kStiffSlack = 1.0 + 1e-9;

/// Upper bound on each diagonal entry of a closure's information. Requires at least one odometry
/// edge.
Twist bound_of(const Problem& problem) {
  Twist largest = Twist::Zero();
  for (const Edge& edge : problem.odometry) {
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
  const Twist bound = kStiffSlack * bound_of(problem);
  return std::ranges::any_of(problem.closures, [&](const Edge& closure) {
    return (closure.information.diagonal().array() > bound.array()).any();
  });
}

Problem with_bounded_stiffness(const Problem& problem) {
  const Twist bound = bound_of(problem);
  Problem out = problem;
  for (Edge& closure : out.closures) {
    const Twist shrink = (bound.array() / closure.information.diagonal().array()).min(1.0).sqrt();
    closure.information = shrink.asDiagonal() * closure.information * shrink.asDiagonal();
  }
  return out;
}

}  // namespace loopbench::methods
