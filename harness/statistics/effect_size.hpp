/// How large a paired difference is, whatever its p.
#pragma once

#include <optional>
#include <span>

#include "harness/statistics/signed_rank.hpp"

namespace loopbench {

/// Matched-pairs rank-biserial correlation (Kerby 2014): favourable less unfavourable share of the
/// rank sum, -1..1; 0 when every difference is zero. Positive when differences are.
double rank_biserial(const SignedRank& test);

/// Cohen's d_z: mean difference over the standard deviation of the differences. None on fewer than
/// two differences, or when they do not vary.
std::optional<double> cohen_dz(std::span<const double> differences);

}  // namespace loopbench
