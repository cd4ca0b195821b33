/// Wilcoxon's signed-rank test of the symmetry of paired differences about zero.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace loopbench::harness {

/// Treatment of differences that are exactly zero. Pratt (1959) ranks them with the others and then
/// drops them, so that many ties make significance harder; Wilcoxon (1945) drops them first.
enum class Zeros { pratt, wilcoxon };

enum class Alternative { two_sided, less, greater };  ///< of the differences, compared with zero

struct SignedRankOptions {
  Zeros zeros = Zeros::pratt;
  Alternative alternative = Alternative::two_sided;
  std::size_t exact_up_to = 50;  ///< non-zero differences; beyond: normal approximation
  bool continuity = true;        ///< continuity correction of the normal approximation
};

struct SignedRank {
  std::size_t count = 0;  ///< number of non-zero differences
  std::size_t zeros = 0;
  double positive = 0.0;  ///< sum of the ranks of positive differences
  double negative = 0.0;
  double p = 1.0;  ///< 1 if every difference is zero
  bool is_exact = true;
};

/// Equal magnitudes share their ranks. The exact p enumerates the sign patterns given the observed
/// ranks, so it is valid with ties and zeros, too (a permutation test); two-sided: twice the
/// smaller tail. No NaN. O(n log n), exact O(n^3) with n <= exact_up_to.
SignedRank signed_rank(std::span<const double> differences, const SignedRankOptions& options = {});

/// The largest sum c of the ranks of one sign with 2 P(sum <= c) <= alpha for n differences without
/// ties; nullopt if there is none. Exact up to 50 differences. O(n^3) then.
std::optional<std::size_t> critical_rank_sum(std::size_t n, double alpha);

/// The smallest two-sided p for n differences: 2^(1 - n), if all have one sign.
double least_p(std::size_t n);

}  // namespace loopbench::harness
