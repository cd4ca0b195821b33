/// Variance components by maximum posterior density: how much of a gap is due to what.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace loopbench {

/// One cause among several: the gap's covariance is sum_j value_j share_j.
struct VarianceComponent {
  Eigen::MatrixXd share;  ///< symmetric positive semidefinite; the lower triangle is read
  double value = 1.0;     ///< > 0
  double prior = 1.0;     ///< median of what value is believed to be, > 0
  double spread = 0.0;    ///< standard deviation of log(value / prior); 0: value is kept
  int group = -1;         ///< components of a group also share an unknown factor; -1: none
};

/// A factor common to all components of a group, around 1.
struct VarianceGroup {
  double log_scale = 0.0;
  double spread = 0.0;  ///< standard deviation of log_scale; 0: it stays as it is
};

/// log N(gap; 0, sum_j value_j share_j). Throws std::runtime_error when that is no covariance.
double log_evidence(const std::vector<VarianceComponent>& components, const Eigen::VectorXd& gap);

/// Log density of the values under their log-normal beliefs, up to a constant.
double log_prior(const std::vector<VarianceComponent>& components,
                 const std::vector<VarianceGroup>& groups);

/// Raises log_evidence + log_prior in every one of `iterations` rounds. With C the gap's
/// covariance, alpha = C^-1 gap, push_j = value_j tr(C^-1 Q_j), pull_j = value_j alpha' Q_j alpha,
/// minus twice the log evidence is at most
///
///     sum_j push_j e^{u_j} + pull_j e^{-u_j} + constant    at values value_j e^{u_j},
///
/// with equality at u = 0: a minorise-maximise step, never down. Adding the beliefs keeps it
/// convex; the groups' factors move first, then each component on its own.
/// Complexity O(iterations (m^3 + J m^2)) for m numbers in the gap and J components.
/// Cause: Zhou, Hu, Zhou, Lange, MM algorithms for variance components models, 2019, without the
/// beliefs; with them as derived here.
void fit(std::vector<VarianceComponent>& components,
         std::vector<VarianceGroup>& groups,
         const Eigen::VectorXd& gap,
         int iterations);

}  // namespace loopbench
