/// L1 trend filter: piecewise linear motion with a sparse set of velocity changes.
#pragma once

#include "methods/method.hpp"

namespace loopbench::methods {

/// Minimises 1/2 sum |y_i - x_i|^2 + lambda sum |change of velocity| over positions, and the same
/// over rotations with great arcs instead of straight lines (unrolled.hpp). The resulting keyframes
/// are joined by straight lines and great arcs. Suitable for vehicles that stop, start and rotate
/// on the spot. lambda is a given share of the smallest value that yields a straight line. Without
/// `share`, it is the best of 24 values from that one down to 1e-6 of it, four per decade, by GCV =
/// (RSS / N) / (1 - df / N)^2, N = 3 n, df = 3 (kinks + 2). For curved rather than piecewise linear
/// motion the fit has kinks everywhere; other smoothers are better there. `refit` keeps the kinks
/// and refits the lines between them without penalty (relaxed lasso), for motion known to be
/// piecewise linear. The fit is then chosen by BIC = N log(RSS / N) + df log N among fits with at
/// most one kink per two keyframes. Nearly O(n): about 30 Newton steps per lambda. Source: Kim,
/// Koh, Boyd & Gorinevsky 2009; Tibshirani 2014 (df); Meinshausen 2007.
class TrendFilter final : public Smoother {
 public:
  struct Options {
    std::optional<double> share = std::nullopt;
    bool refit = false;
  };
  explicit TrendFilter(const Options& options) : options_(options) {}

  std::string why_declined(const Problem& problem) const override;

  /// Counts: `kinks_t`, `kinks_r`, `lambda_t` [m s], `lambda_r` [rad s], `iterations` (total Newton
  /// steps). Adds notes when a solve or the rotation rounds stop before convergence.
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

template <class Visit>
void fields(TrendFilter::Options& o, Visit visit) {
  visit("share",
        o.share,
        "lambda as a fraction of the smallest value that yields a straight line [-]; none: chosen "
        "by GCV or BIC",
        Between{1e-6, 1});
  visit("refit", o.refit, "keep the kinks found and refit the lines between them without penalty");
}

}  // namespace loopbench::methods
