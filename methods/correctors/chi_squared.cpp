#include "methods/correctors/chi_squared.hpp"

#include <algorithm>
#include <cmath>

namespace loopbench::methods {

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

bool is_unlikely(double chi2, std::size_t dof) {
  constexpr double kNormalQuantile = 3.2905;  // 99.95 %
  if (dof == 0) return false;
  const auto count = static_cast<double>(dof);
  const double variance = 2.0 / (9.0 * count);
  const double root = std::max(0.0, 1.0 - variance + kNormalQuantile * std::sqrt(variance));
  return chi2 > count * std::pow(root, 3);
}

void count_chi2_per_dof(double chi2, std::size_t dof, Report& report) {
  if (dof > 0 && std::isfinite(chi2)) {
    report.count("chi2_per_dof", chi2 / static_cast<double>(dof));
  }
}

}  // namespace loopbench::methods
