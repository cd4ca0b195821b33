/// Consistency of information matrices: loop gaps and repeated measurements relative to their
/// stated covariance.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench::rgbd {

/// Returns c' S^-1 c / 6 for each closure, where c is the twist between the measured closure and
/// the same motion composed from odometry, and S is its covariance from both to first order. The
/// mean is 1 for correct information. Odometry must connect all consecutive keyframes. The
/// reference is not used. O(odometry + closures).
std::vector<double> normalised_gaps(const std::vector<Edge>& odometry,
                                    const std::vector<Edge>& closures);

/// Returns the normalised squared distance (divided by 6) between two measurements of each edge.
/// `first` holds the first measurements, `again` the fusion of both, with the sum of their
/// information. The mean is 1 for correct information. Edges without a second measurement are
/// omitted. O(edges).
std::vector<double> repeated_measurement_gaps(const std::vector<Edge>& first,
                                              const std::vector<Edge>& again);

/// Ratio of the median gap and the median of chi^2 with six degrees of freedom. Information divided
/// by this factor has the correct scale, even with a few false closures. 1 for fewer than eight
/// gaps.
double information_excess(std::vector<double> gaps);

}  // namespace loopbench::rgbd
