#include "harness/article/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace loopbench::harness {

Verdict verdict_on_change(double printed, double ours) {
  if (!std::isfinite(ours)) return Verdict::cannot_be_judged;
  if (std::abs(ours) < kTiedChange)
    return std::abs(printed) < kTiedChange ? Verdict::holds : Verdict::tie;
  if ((ours < 0.0) != (printed < 0.0)) return Verdict::does_not_hold;
  const double factor = std::abs(ours / printed);
  return std::max(factor, 1.0 / factor) <= kComparable ? Verdict::holds : Verdict::other_size;
}

Verdict verdict_on_smallest(double error, double smallest_other) {
  if (error * (1.0 + kTiedChange) < smallest_other) return Verdict::holds;
  return error <= smallest_other * (1.0 + kTiedChange) ? Verdict::tie : Verdict::does_not_hold;
}

std::string signed_tenths(double value) {
  return fmt::format("{:+.1f}", std::abs(value) < 0.05 ? 0.0 : value);
}

std::string percent_change(double change) {
  if (std::abs(change) < 0.1) return signed_tenths(100.0 * change) + " %";
  return fmt::format("{:+.0f} %", 100.0 * change);
}

}  // namespace loopbench::harness
