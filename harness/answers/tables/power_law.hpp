/// A power of the size beside a fixed cost.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace loopbench::harness {

/// y = fixed + factor * size^exponent, with relative errors of equal size.
struct PowerLaw {
  double fixed = 0.0;
  double factor = 0.0;
  double exponent = 0.0;
  /// Of the 95 % interval of the exponent: its farther end. None for three sizes, which any fixed
  /// cost fits.
  std::optional<double> half_width = {};
  double rms = 0.0;  ///< of y minus the law, relative to the mean of y
};

/// Least squares with an exponent of 0 to 4 and no negative cost; the interval has all exponents
/// whose sum of squares Student's distribution does not exclude (Bates and Watts, 1988, 6.1). None
/// for fewer than three different sizes, or values that are not positive. O(n).
std::optional<PowerLaw> fitted_power(const std::vector<double>& sizes,
                                     const std::vector<double>& values);

/// "O(n^1.02 ± 0.05)"; "O(n^1.02)" without an interval, "-" without a law.
std::string law_text(const std::optional<PowerLaw>& law);

}  // namespace loopbench::harness
