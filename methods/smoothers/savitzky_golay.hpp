/// Local polynomial regression in time, one polynomial per keyframe.
#pragma once

#include "methods/method.hpp"

namespace loopbench::methods {

/// For each keyframe c, fits a polynomial of degree d in time by least squares to the keyframes of
/// a window: positions, and rotations as Log(R_c^T R_j) in the tangent space of the centre. Stamps
/// may be uneven. Windows of n keyframes shift inwards at the ends. Windows in seconds are
/// truncated at the ends, and extended to d + 1 keyframes if they hold fewer. Between keyframes the
/// two neighbouring polynomials are blended with the weight 3 u^2 - 2 u^3 (rotations along the
/// great arc). The curve is C1 and reproduces polynomial motions of degree d; it does not
/// interpolate the keyframes. O(n window d) to construct, O(d) amortised per query. Sources:
/// Savitzky & Golay 1964; the discrete orthogonal polynomials are Forsythe's (1957).
class SavitzkyGolay final : public Smoother {
 public:
  struct Options {
    int degree = 3;
    int window = 7;                                ///< [keyframes]
    std::optional<double> seconds = std::nullopt;  ///< width in time, replaces `window` [s]
  };
  static constexpr int kMaxDegree = 5;

  /// Throws OptionError when the window holds fewer than degree + 1 keyframes.
  explicit SavitzkyGolay(const Options& options);

  std::string why_declined(const Problem& problem) const override;

  /// Counts: `window`, the mean number of keyframes per window.
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

template <class Visit>
void fields(SavitzkyGolay::Options& o, Visit visit) {
  visit(
      "degree", o.degree, "degree of the local polynomials", Between{0, SavitzkyGolay::kMaxDegree});
  visit("window",
        o.window,
        "number of keyframes in a window; must exceed the degree",
        Between{1, 1e4});
  visit("seconds",
        o.seconds,
        "window width in time, replaces `window` [s]; none: use `window`",
        GreaterThan{0.0});
}

}  // namespace loopbench::methods
