/// Batch Gaussian process regression on SE(3): keyframes are noisy samples of a smooth motion.
#pragma once

#include "methods/method.hpp"

namespace loopbench::methods {

/// The motion prior is driven by white noise on acceleration (constant velocity is expected, WNOA).
/// Keyframes are pose measurements with white noise. The method computes the most probable poses
/// and velocities. Between keyframes it evaluates the posterior mean, in local coordinates xi =
/// Log(T_i^-1 T) = Lambda(t) gamma_i + Psi(t) gamma_{i+1}: C1. For translation alone it is the
/// smoothing spline.
///
/// The measurement and motion noise of translation and rotation are estimated by maximum marginal
/// likelihood (Laplace approximation, relinearised once, from two starts) unless given. As with
/// every smoother, drift that is slow relative to the keyframe rate cannot be distinguished from
/// motion and remains. Intervals above 50 or below 0.05 times the median are bridged by chords
/// between separately smoothed segments. O(n): about 150 block tridiagonal eliminations with blocks
/// of 12, and 2 kB per keyframe. Sources: Anderson & Barfoot 2015; Barfoot, ch. 11.
class GaussianProcess final : public Smoother {
 public:
  struct Options {
    std::optional<double> sigma_t = std::nullopt;  ///< [m]
    std::optional<double> sigma_r = std::nullopt;  ///< [rad]
    std::optional<double> power_t = std::nullopt;  ///< [m^2/s^3]
    std::optional<double> power_r = std::nullopt;  ///< [rad^2/s^3]
    bool covariances = false;
  };
  explicit GaussianProcess(const Options& options) : options_(options) {}

  std::string why_declined(const Problem& problem) const override;

  /// Counts: `sigma_t` [m], `sigma_r` [rad], `power_t`, `power_r` (per s^3), `iterations`,
  /// `evaluations` of the evidence. Phases: `evidence`, `solve`. States covariances if asked: those
  /// of the posterior at its parameters, which do not include drift; none if a
  /// segment is too short. Throws std::runtime_error when the
  /// normal equations are singular.
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

 private:
  std::unique_ptr<const Curve> smooth_segment(const Trajectory& keyframes, Report& report) const;

  Options options_;
};

template <class Visit>
void fields(GaussianProcess::Options& o, Visit visit) {
  visit("sigma_t",
        o.sigma_t,
        "standard deviation of keyframe positions [m]; none: estimated",
        GreaterThan{0.0});
  visit("sigma_r",
        o.sigma_r,
        "standard deviation of keyframe rotations [rad]; none: estimated",
        GreaterThan{0.0});
  visit("power_t",
        o.power_t,
        "power spectral density of the translation prior [m^2/s^3]; none: estimated",
        GreaterThan{0.0});
  visit("power_r",
        o.power_r,
        "power spectral density of the rotation prior [rad^2/s^3]; none: estimated",
        GreaterThan{0.0});
  visit("covariances", o.covariances, "state the covariance of each keyframe, for metric nees");
}

}  // namespace loopbench::methods
