/// Lengths as people write them: "100", "0.5" in metres, "20%" as part of something.
#pragma once

#include <string>
#include <vector>

namespace loopbench {

struct Length {
  std::string text;  ///< "100 m" or "20%", for labels
  double value = 0.0;
  bool is_share = false;  ///< value is a part: 0.2 for 20%

  double of(double whole) const { return is_share ? value * whole : value; }
};

/// Positive numbers between blanks, each with or without `%`, metres may end in `m`. Throws
/// OptionError naming `option` for an empty list and for what is not a positive number.
std::vector<Length> lengths(const std::string& option, const std::string& text);

/// One length, which may be zero.
Length tolerance(const std::string& option, const std::string& text);

}  // namespace loopbench
