/// Consistency of information matrices: loop gaps and repeated measurements relative to their
/// stated covariance.
#pragma once

#include <vector>

#include "datasets/core/factorisations.hpp"
#include "datasets/core/problem.hpp"
#include "datasets/core/upper_median.hpp"

namespace loopbench::rgbd {

inline constexpr double kMedianOfSix =
    5.348 / 6.0;  // median of chi^2 with 6 degrees of freedom, divided by 6

inline Matrix6 transformed(const Pose& a_from_b, const Matrix6& covariance) {
  const Matrix6 A = adjoint(a_from_b);
  return A * covariance * A.transpose();
}

/// Returns c' S^-1 c / 6 for each closure, where c is the twist between the measured closure and
/// the same motion composed from odometry, and S is its covariance from both to first order. The
/// mean is 1 for correct information. Odometry must connect all consecutive keyframes. The
/// reference is not used. O(odometry + closures).
inline std::vector<double> normalised_gaps(const std::vector<Edge>& odometry,
                                           const std::vector<Edge>& closures) {
  // chain[k]: pose of keyframe k in the frame of the first keyframe. accumulated[k]: covariance up
  // to k as a twist of the first frame, so that the covariance between two keyframes is a
  // difference.
  std::vector<Pose> chain{Pose{Rotation::Identity(), Vector3::Zero()}};
  std::vector<Matrix6> accumulated{Matrix6::Zero()};
  for (const Edge& edge : odometry) {
    chain.push_back(normalized(chain.back() * edge.from_from_to));
    accumulated.push_back(accumulated.back() +
                          transformed(chain.back(), inverse_of(edge.information)));
  }
  std::vector<double> out;
  for (const Edge& loop : closures) {
    const Pose odometry_motion = chain[loop.from].inverse() * chain[loop.to];
    const Pose gap = loop.from_from_to.inverse() * odometry_motion;
    const Twist c = log_se3(gap);
    const Matrix6 odometry_covariance =
        transformed(chain[loop.to].inverse(), accumulated[loop.to] - accumulated[loop.from]);
    const Matrix6 S =
        odometry_covariance + transformed(gap.inverse(), inverse_of(loop.information));
    out.push_back(c.dot(S.ldlt().solve(c)) / 6.0);
  }
  return out;
}

/// Returns the normalised squared distance (divided by 6) between two measurements of each edge.
/// `first` holds the first measurements, `again` the fusion of both, with the sum of their
/// information. The mean is 1 for correct information. Edges without a second measurement are
/// omitted. O(edges).
inline std::vector<double> repeated_measurement_gaps(const std::vector<Edge>& first,
                                                     const std::vector<Edge>& again) {
  std::vector<double> out;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const Matrix6 second = again[i].information - first[i].information;
    if (second.isZero()) continue;
    // At the fused estimate the weighted residuals of both measurements are equal:
    // first * moved = second * (residual of the second measurement).
    const Twist moved = log_se3(first[i].from_from_to.inverse() * again[i].from_from_to);
    const Twist gradient = first[i].information * moved;
    // Surfaces may not observe all directions.
    const Matrix6 regularised = second + 1e-6 * Matrix6::Identity();
    out.push_back((moved.dot(gradient) + gradient.dot(regularised.ldlt().solve(gradient))) / 6.0);
  }
  return out;
}

/// Ratio of the median gap and the median of chi^2 with six degrees of freedom. Information divided
/// by this factor has the correct scale, even with a few false closures. 1 for fewer than eight
/// gaps.
inline double information_excess(std::vector<double> gaps) {
  constexpr std::size_t kMinGaps = 8;  // for a meaningful median
  return gaps.size() < kMinGaps ? 1.0 : upper_median(gaps) / kMedianOfSix;
}

}  // namespace loopbench::rgbd
