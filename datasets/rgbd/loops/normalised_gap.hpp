/// What loops leave open, over what their edges' information lets expect.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

/// Of each closure c' S^-1 c / 6: c is the twist between the measured loop and the same motion
/// chained over odometry, S its covariance from both, to first order; 1 on average when the
/// information is right. Odometry joins every two neighbours. No reference is looked at.
/// O(odometry + closures).
std::vector<double> normalised_gaps(const std::vector<Edge>& odometry,
                                    const std::vector<Edge>& closures);

/// The median gap over that of chi^2 of six degrees: information divided by it is right in scale,
/// whatever few false closures there are. 1 for fewer than `fewest` closures.
double information_excess(const std::vector<Edge>& odometry,
                          const std::vector<Edge>& closures,
                          std::size_t fewest);

}  // namespace loopbench
