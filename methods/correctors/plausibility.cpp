#include "methods/correctors/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "methods/correctors/consensus/judgement.hpp"

namespace loopbench::methods {
namespace {

constexpr double kNormalQuantile = 3.2905;  // 99.95 %

/// Quantile of chi2 per degree of freedom at `z` standard deviations.
double quantile(double z, std::size_t dof) {
  const double variance = 2.0 / (9.0 * static_cast<double>(dof));
  return std::pow(std::max(0.0, 1.0 - variance + z * std::sqrt(variance)), 3);
}

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

double inlier_chi2(std::size_t dof) {
  if (dof == 3) return 11.345;
  if (dof == 4) return 13.277;
  return dof == 6 ? 16.812 : 18.475;
}

std::size_t degrees_of_freedom(std::size_t keyframes, std::size_t edges, std::size_t dimensions) {
  return edges + 1 > keyframes ? dimensions * (edges + 1 - keyframes) : 0;
}

std::size_t degrees_of_freedom(const Problem& problem) {
  return degrees_of_freedom(problem.keyframes.size(),
                            problem.odometry.size() + problem.closures.size(),
                            problem.planar ? 3 : 6);
}

bool is_too_large(double chi2, std::size_t dof) {
  return dof > 0 && chi2 > static_cast<double>(dof) * quantile(kNormalQuantile, dof);
}

void report_chi2(double chi2, std::size_t dof, const Problem& problem, Report& report) {
  constexpr double kFar = 4.0;
  if (dof == 0 || !std::isfinite(chi2)) return;
  const double ratio = chi2 / static_cast<double>(dof);
  report.count("chi2_per_dof", ratio);
  const bool is_high = ratio > kFar && is_too_large(chi2, dof);
  const bool is_low = ratio < 1.0 / kFar && ratio < quantile(-kNormalQuantile, dof);
  const bool is_judged = problem.anchors.empty() && why_not_judged(problem).empty();
  if ((!is_high && !is_low) || is_judged) return;
  report.notes.push_back(
      fmt::format("chi2 per degree of freedom is {:.3g} with {} degrees of freedom: the stated "
                  "covariances are too {}",
                  ratio,
                  dof,
                  is_high ? "small, or some closures are false" : "large"));
}

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
