/// Wilcoxon's signed-rank test: are paired differences symmetric about zero?
#pragma once

#include <cstddef>
#include <span>

namespace loopbench {

/// What becomes of differences that are exactly zero. Pratt (1959) ranks them with the others and
/// then drops them, so that many ties make a difference harder to show; Wilcoxon (1945) drops them
/// first.
enum class Zeros { pratt, wilcoxon };

enum class Alternative { two_sided, less, greater };  ///< of the differences, against zero

struct SignedRankOptions {
  Zeros zeros = Zeros::pratt;
  Alternative alternative = Alternative::two_sided;
  std::size_t exact_up_to = 50;  ///< differences that are not zero; beyond: the normal distribution
  bool continuity = true;        ///< of the normal approximation: half a rank towards the mean
};

struct SignedRank {
  std::size_t count = 0;  ///< differences that are not zero
  std::size_t zeros = 0;
  double positive = 0.0;  ///< sum of the ranks of positive differences
  double negative = 0.0;
  double p = 1.0;  ///< 1 when every difference is zero
  bool is_exact = true;
};

/// Equal magnitudes share their ranks. The exact p counts the sign patterns given the ranks at
/// hand, so that it holds with ties and zeros too (a permutation test); two-sided: twice the
/// smaller tail. No NaN. O(n log n), exact O(n^3) with n <= exact_up_to.
SignedRank signed_rank(std::span<const double> differences, const SignedRankOptions& options = {});

/// Matched-pairs rank-biserial correlation (Kerby 2014): share of the rank sum of positive
/// differences less that of negative ones, -1..1; 0 when every difference is zero.
double rank_biserial(const SignedRank& test);

/// The least two-sided p that n differences can reach: 2^(1 - n), all of one sign.
double least_p(std::size_t n);

}  // namespace loopbench
