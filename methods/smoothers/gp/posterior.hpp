/// Most probable states of a Gaussian process on SE(3), given noisy poses.
#pragma once

#include <vector>

#include "datasets/core/trajectory.hpp"
#include "methods/smoothers/gp/link.hpp"

namespace loopbench::methods {

/// Hyperparameters. The unit of time is the mean interval between the poses.
struct GpParameters {
  double sigma_t, sigma_r;  ///< standard deviation of a measured pose [m], [rad]
  double power_t, power_r;  ///< power of the driving noise [m^2], [rad^2] per interval
};

/// Minimises, by Gauss-Newton on the block tridiagonal normal equations,
///
///     1/2 sum_i |Log(M_i^-1 T_i)|^2_R + 1/2 sum_i |link(state_i, state_{i+1})|^2_Q,
///
/// with blocks of size 6 P. O(n) per iteration. Source: Anderson & Barfoot 2015; Barfoot, ch. 11.
template <int P>
class GpPosterior {
 public:
  using States = std::vector<GpState<P>>;

  /// Requires at least P + 1 poses.
  explicit GpPosterior(const Trajectory& measured);

  double interval() const { return interval_; }                      ///< mean [s]
  double interval_of(std::size_t i) const { return intervals_[i]; }  ///< [mean intervals]

  /// Initial states: the measured poses, and rates from finite differences.
  States initial_states() const;

  /// Minimises the cost starting from `states`; returns the number of iterations. Deterministic.
  /// Throws std::runtime_error when the normal equations are not positive definite.
  int solve(States& states, const GpParameters& parameters) const;

  /// Returns -log p(measured | parameters) up to a constant by the Laplace approximation at
  /// `states`: the cost at its linearised minimum + half the log determinants of the normal matrix,
  /// of Q and of R. One elimination, O(n).
  double negative_evidence(const States& states, const GpParameters& parameters) const;

 private:
  struct Step {
    GpMatrix<P> to_next;  ///< delta_i = offset - to_next * delta_{i + 1}
    GpVector<P> offset;
  };
  struct Elimination {
    double cost, decrease, log_determinant;
  };
  Elimination eliminate(const States& states,
                        const GpParameters& parameters,
                        std::vector<Step>* steps) const;
  double cost(const States& states, const GpParameters& parameters) const;

  std::vector<Pose> measured_;
  std::vector<double> intervals_;  ///< between the poses [mean intervals]
  double interval_;
  double extent_ = 1.0;  ///< scale of the convergence threshold, at least 1 [m]
};

extern template class GpPosterior<2>;
extern template class GpPosterior<3>;

}  // namespace loopbench::methods
