/// Lengths as text: "100" or "0.5" in metres, "20%" relative to a whole.
#pragma once

#include <string>
#include <vector>

namespace loopbench::metrics {

struct Length {
  std::string text;  ///< "100 m" or "20%", for labels
  double value = 0.0;
  bool is_share = false;  ///< value is a fraction: 0.2 for 20%

  double of(double whole) const { return is_share ? value * whole : value; }
};

/// Positive numbers separated by blanks, each optionally with `%` or `m`. Throws OptionError naming
/// `option` for an empty list or anything but positive numbers.
std::vector<Length> lengths(const std::string& option, const std::string& text);

/// One length, which can be zero.
Length tolerance(const std::string& option, const std::string& text);

}  // namespace loopbench::metrics
