/// Answers a claim from a comparison, with correction for repeated looks.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "datasets/core/error.hpp"
#include "harness/compare/compare.hpp"
#include "harness/model/claim.hpp"

namespace loopbench::harness {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// "23.1 % below raw", "0.4 % above raw".
inline std::string relative_text(double ratio, const std::string& other) {
  return fmt::format(
      "{:.1f} % {} {}", 100.0 * std::abs(1.0 - ratio), ratio <= 1.0 ? "below" : "above", other);
}

inline std::string claimed_text(const Claim& claim) {
  if (claim.margin == 0.0) return "below " + claim.baseline;
  return claim.margin > 0.0
             ? fmt::format("at least {:g} % below {}", 100.0 * claim.margin, claim.baseline)
             : fmt::format("at most {:g} % above {}", -100.0 * claim.margin, claim.baseline);
}

/// What the interval and the geometric mean ratio of a look say about the claim, whose margin may
/// have been edited since.
inline ClaimAnswer answer_of(const Claim& claim, const Look& look) {
  const double limit = 1.0 - claim.margin;
  const bool has_mean = std::isfinite(look.mean);
  if (look.high < limit && !(has_mean && look.mean >= limit)) return ClaimAnswer::holds;
  if (look.low > limit && !(has_mean && look.mean <= limit)) return ClaimAnswer::does_not_hold;
  return ClaimAnswer::cannot_tell;
}

/// Level of the k-th look (from 1): two thirds of alpha for the first, alpha / (3 k (k - 1)) for
/// the others, whose sum is alpha however often one looks. At 0.05 seven equal signs can decide at
/// the first look, ten at the second.
inline double level_of_look(double alpha, std::size_t k) {
  const auto n = static_cast<double>(k);
  return k <= 1 ? alpha * 2.0 / 3.0 : alpha / (3.0 * n * (n - 1.0));
}

/// The answer of one look at `level`. The interval of the typical ratio decides: *holds* if it lies
/// below 1 - margin, *does not hold* if it lies above, otherwise *cannot tell*, as with too few
/// groups or a geometric mean ratio on the other side. `comparison` was made at that level with the
/// claim's baseline. Throws InputError if a method is missing, with the reason.
inline Look look_at(const Claim& claim, const Comparison& comparison, double level) {
  const auto found = std::ranges::find(comparison.methods, claim.method, &MethodVerdict::method);
  if (found == comparison.methods.end()) {
    throw InputError(claim.file.string() + ": " + verdict(comparison));
  }
  Look out;
  out.level = level;
  out.wins = found->wins;
  out.losses = found->losses;
  out.low = 0.0;
  out.high = kInfinity;
  out.mean = std::nan("");
  if (found->ratio) {
    // Of scores that should be large, the ratio of the inverse is below 1 for the better method.
    const bool is_inverse = comparison.kind.better == metrics::Better::higher;
    const Interval& typical = found->ratio->typical;
    const auto cost = [&](double ratio) { return is_inverse ? 1.0 / ratio : ratio; };
    out.ratio = cost(typical.estimate);
    if (found->ratio->has_interval) {
      out.low = std::min(cost(typical.low), cost(typical.high));
      out.high = std::max(cost(typical.low), cost(typical.high));
    }
    if (found->ratio->geometric_mean) out.mean = cost(*found->ratio->geometric_mean);
  }
  out.answer = answer_of(claim, out);
  return out;
}

/// Whether two looks saw the same results, to six digits: the second one tells nothing new.
inline bool has_same_results(const Look& a, const Look& b) {
  const auto is_same = [](double x, double y) {
    return fmt::format("{:.6g}", x) == fmt::format("{:.6g}", y);
  };
  return is_same(a.ratio, b.ratio) && is_same(a.mean, b.mean) && a.wins == b.wins &&
         a.losses == b.losses;
}

/// "dual is 23.1 % below raw [18.0, 29.9] (interval of 96.7 %), 12 groups better, 4 worse; claimed:
/// at least 5 % below".
inline std::string text_of(const Claim& claim, const Look& look) {
  const std::string interval =
      std::isfinite(look.high)
          ? fmt::format("ratio {:.3f} [{:.3f}, {:.3f}] at {:.1f} %",
                        look.ratio,
                        look.low,
                        look.high,
                        100.0 * (1.0 - look.level))
          : fmt::format("ratio {:.3f}, too few groups for an interval at {:.1f} %",
                        look.ratio,
                        100.0 * (1.0 - look.level));
  return fmt::format("{} is {} ({}; {} better, {} worse); claimed: {}",
                     claim.method,
                     relative_text(look.ratio, claim.baseline),
                     interval,
                     look.wins,
                     look.losses,
                     claimed_text(claim));
}

}  // namespace loopbench::harness
