/// The most probable states of a Gaussian process on SE(3) that noisy poses were drawn from.
#pragma once

#include <vector>

#include "datasets/core/trajectory.hpp"
#include "methods/smoothers/gp/link.hpp"

namespace loopbench {

/// Time runs in mean intervals between the poses.
struct GpParameters {
  double sigma_t, sigma_r;  ///< of a measured pose [m], [rad]
  double power_t, power_r;  ///< of the driving noise [m^2], [rad^2] per interval
};

/// Minimises, by Gauss-Newton on the block tridiagonal normal equations,
///
///     1/2 sum_i |Log(M_i^-1 T_i)|^2_R + 1/2 sum_i |link(state_i, state_{i+1})|^2_Q,
///
/// O(n) an iteration, blocks of 6 P. Source: Anderson & Barfoot 2015; Barfoot, ch. 11.
template <int P>
class GpPosterior {
 public:
  using States = std::vector<GpState<P>>;

  /// P + 1 poses or more.
  explicit GpPosterior(const Trajectory& measured);

  double interval() const { return interval_; }                 ///< mean [s]
  double interval_of(std::size_t i) const { return gaps_[i]; }  ///< [mean intervals]

  /// Measured poses, rates from differences.
  States first_guess() const;

  /// Iterates from `states`; the number of steps. Deterministic; throws std::runtime_error when the
  /// normal equations are not positive definite.
  int solve(States& states, const GpParameters& parameters) const;

  /// -log p(measured | parameters) up to a constant, by Laplace at `states`: half the cost at its
  /// linear minimum + half log det of the normal matrix, of Q and of R. One elimination, O(n).
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
  std::vector<double> gaps_;
  double interval_;
  double extent_ = 1.0;  ///< [m], at least 1: what convergence is relative to
};

extern template class GpPosterior<2>;
extern template class GpPosterior<3>;

}  // namespace loopbench
