/// Batch estimation of a Gaussian process on SE(3): keyframes as noisy samples of smooth motion.
#pragma once

#include "methods/method.hpp"

namespace loopbench {

/// White noise drives the body's acceleration (prior velocity: constant velocity is what is
/// expected, WNOA) or its jerk (prior acceleration, WNOJ); keyframes are poses measured with white
/// noise. The most probable poses and velocities, and between keyframes the posterior mean, which
/// in local coordinates xi = Log(T_i^-1 T) reads Lambda(t) gamma_i + Psi(t) gamma_{i+1}: C1 for
/// WNOA, C2 for WNOJ but for terms of the order of the turn within an interval. In translation
/// alone, WNOA is the smoothing spline.
/// The noise of poses and motion, of translation and rotation each, comes from the marginal
/// likelihood (Laplace, relinearised once, from two starts) unless given. As with every smoother,
/// drift that is slow against the keyframes looks like motion and stays. Intervals above 50 or
/// below 0.05 times the median are chords between stretches smoothed apart. O(n): some 150 block
/// tridiagonal eliminations, blocks of 12 (18), and 2 (5) kB a keyframe. Source: Anderson & Barfoot
/// 2015 (WNOA); Tang, Yoon & Barfoot 2019 (WNOJ); Barfoot, ch. 11.
class GaussianProcess final : public Smoother {
 public:
  enum class Prior { velocity, acceleration };
  struct Options {
    Prior prior = Prior::velocity;
    std::optional<double> sigma_t = std::nullopt;  ///< [m]
    std::optional<double> sigma_r = std::nullopt;  ///< [rad]
    std::optional<double> power_t = std::nullopt;  ///< [m^2/s^3], [m^2/s^5]
    std::optional<double> power_r = std::nullopt;  ///< [rad^2/s^3], [rad^2/s^5]
  };
  explicit GaussianProcess(const Options& options) : options_(options) {}

  std::optional<std::string> declines(const Problem& problem) const override;

  /// Counts: `sigma_t` [m], `sigma_r` [rad], `power_t`, `power_r` (per s^3 or s^5), `iterations`,
  /// `evaluations` of the evidence. Phases: `evidence`, `solve`. Throws std::runtime_error when the
  /// normal equations break down.
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

 private:
  std::size_t least_keyframes() const;

  template <int P>
  std::unique_ptr<const Curve> smooth_with(const Trajectory& keyframes, Report& report) const;

  Options options_;
};

inline auto choices(GaussianProcess::Prior) {
  return std::array{std::pair{"velocity", GaussianProcess::Prior::velocity},
                    std::pair{"acceleration", GaussianProcess::Prior::acceleration}};
}

template <class Visit>
void fields(GaussianProcess::Options& o, Visit visit) {
  visit("prior", o.prior, "what is constant but for white noise: WNOA, WNOJ");
  visit("sigma_t", o.sigma_t, "of keyframe positions [m]; none: by evidence", Above{0.0});
  visit("sigma_r", o.sigma_r, "of keyframe attitudes [rad]; none: by evidence", Above{0.0});
  visit("power_t", o.power_t, "of the noise [m^2/s^3 or /s^5]; none: by evidence", Above{0.0});
  visit("power_r", o.power_r, "of the noise [rad^2/s^3 or /s^5]; none: by evidence", Above{0.0});
}

}  // namespace loopbench
