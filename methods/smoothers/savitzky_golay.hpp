/// Local polynomials in time, one around each keyframe.
#pragma once

#include "methods/method.hpp"

namespace loopbench {

/// Around keyframe c a polynomial of degree d in time is fitted by least squares to the keyframes
/// of a window: positions, and attitudes as Log(R_c^T R_j) in the tangent space of the centre.
/// Stamps may be uneven. Windows of n keyframes move inwards at the ends; windows in seconds are
/// cut there, and widened to d + 1 keyframes where they hold fewer. Between keyframes the two
/// neighbouring polynomials are blended by 3 u^2 - 2 u^3 (attitudes along the great arc): the curve
/// is C1 and motions polynomial of degree d are reproduced.
/// Keyframes are not passed through. O(n window d) to make, O(d) amortised to ask.
/// Source: Savitzky & Golay 1964; the discrete orthogonal polynomials are Forsythe's (1957).
class SavitzkyGolay final : public Smoother {
 public:
  struct Options {
    int degree = 3;
    int window = 7;                                ///< [keyframes]
    std::optional<double> seconds = std::nullopt;  ///< window instead [s]
  };
  static constexpr int kMostDegree = 5;

  /// Throws OptionError when the window cannot hold degree + 1 keyframes.
  explicit SavitzkyGolay(const Options& options);

  std::optional<std::string> declines(const Problem& problem) const override;

  /// Counts: `window`, the mean number of keyframes in one.
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

template <class Visit>
void fields(SavitzkyGolay::Options& o, Visit visit) {
  visit("degree", o.degree, "of the polynomials", Between{0, SavitzkyGolay::kMostDegree});
  visit("window", o.window, "keyframes in a window, more than the degree", Between{1, 1e4});
  visit("seconds", o.seconds, "window in seconds instead; none: by keyframes", Above{0.0});
}

}  // namespace loopbench
