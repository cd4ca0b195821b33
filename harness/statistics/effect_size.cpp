#include "harness/statistics/effect_size.hpp"

#include "harness/statistics/average.hpp"

namespace loopbench {

double rank_biserial(const SignedRank& test) {
  const double total = test.positive + test.negative;
  return total > 0.0 ? (test.positive - test.negative) / total : 0.0;
}

std::optional<double> cohen_dz(std::span<const double> differences) {
  if (differences.size() < 2) return std::nullopt;
  const double deviation = sample_deviation(differences);
  if (!(deviation > 0.0)) return std::nullopt;
  return mean(differences) / deviation;
}

}  // namespace loopbench
