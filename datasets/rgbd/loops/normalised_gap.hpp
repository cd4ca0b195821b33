/// What loops leave open, or a second measurement moves, over what information lets expect.
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

/// Of each edge that was measured a second time (`again` is both together, its information theirs
/// added up): how far the two lie apart over what both say, over 6; 1 on average when the
/// information is right. Edges that stayed as they were are left out. O(edges).
std::vector<double> remeasured_gaps(const std::vector<Edge>& first, const std::vector<Edge>& again);

/// information_excess() over remeasured_gaps().
double remeasured_excess(const std::vector<Edge>& first,
                         const std::vector<Edge>& again,
                         std::size_t fewest);

}  // namespace loopbench
