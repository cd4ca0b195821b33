/// L1 trend filter: piecewise straight motion with as few bends as the data ask for.
#pragma once

#include "methods/method.hpp"

namespace loopbench {

/// Minimises 1/2 sum |y_i - x_i|^2 + lambda sum |change of velocity| over positions, and the same
/// over attitudes with great arcs for straight lines (unrolled.hpp), then joins the keyframes so
/// found by straight lines and great arcs: right for what stops, goes and turns on the spot.
/// lambda: a share of the least one that gives a straight line; or, with none, the best of a path
/// from that one down to 1e-6 of it, four a decade, by GCV = (RSS / N) / (1 - df / N)^2, N = 3 n,
/// df = 3 (kinks + 2). On a motion that is curved rather than piecewise straight, kinks are
/// everywhere and steps are cut: other smoothers are better there.
/// `refit` keeps the bends and fits the lines between them without penalty (the relaxed lasso), for
/// motion known to be piecewise straight: chosen by BIC = N log(RSS / N) + df log N among fits with
/// one kink for two keyframes at most. Near O(n): some 30 Newton steps for each lambda.
/// Source: Kim, Koh, Boyd & Gorinevsky 2009; Tibshirani 2014 (df); Meinshausen 2007.
class TrendFilter final : public Smoother {
 public:
  enum class Turn { slerp, filtered };
  struct Options {
    std::optional<double> share = std::nullopt;
    bool refit = false;
    double tolerance = 1e-4;
    int max_iterations = 300;
    Turn rotation = Turn::filtered;
  };
  explicit TrendFilter(const Options& options) : options_(options) {}

  std::optional<std::string> declines(const Problem& problem) const override;

  /// Counts: `kinks_t`, `kinks_r`, `lambda_t` [m s], `lambda_r` [rad s], `iterations`
  /// (Newton steps) in all. Notes when they or the attitude's rounds end before they converge.
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

inline auto choices(TrendFilter::Turn) {
  return std::array{std::pair{"slerp", TrendFilter::Turn::slerp},
                    std::pair{"filtered", TrendFilter::Turn::filtered}};
}

template <class Visit>
void fields(TrendFilter::Options& o, Visit visit) {
  visit("share",
        o.share,
        "of the lambda that gives a straight line; none: by GCV or BIC",
        Between{1e-6, 1});
  visit("refit", o.refit, "keep the bends found, fit the lines between them without penalty");
  visit("tolerance",
        o.tolerance,
        "distance from the optimum over that from the data [-]",
        Between{1e-12, 0.1});
  visit("max_iterations", o.max_iterations, "Newton steps for each lambda", Between{1, 1e6});
  visit("rotation", o.rotation, "slerp: attitudes kept; filtered: as the positions are");
}

}  // namespace loopbench
