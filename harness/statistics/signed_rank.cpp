#include "harness/statistics/signed_rank.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "harness/statistics/normal.hpp"

namespace loopbench::harness {
namespace {

struct Tails {
  double lower;  ///< P(T <= t)
  double upper;  ///< P(T >= t)
};

/// Exact distribution of the sum of ranks with random signs, which is symmetric, so that only the
/// sums of the smaller tail are needed. Midranks are doubled to be integers. Up to 53 ranks all
/// probabilities are multiples of 2^-53, without rounding.
Tails exact_tails(const std::vector<double>& ranks, double t) {
  const bool is_whole = std::ranges::all_of(ranks, [](double r) { return r == std::floor(r); });
  const double scale = is_whole ? 1.0 : 2.0;
  const auto scaled = [&](double rank) {
    return static_cast<std::size_t>(std::lround(scale * rank));
  };
  std::size_t total = 0;
  for (const double rank : ranks) total += scaled(rank);
  const std::size_t at = scaled(t);
  const std::size_t most = std::min(at, total - at);
  std::vector<double> chance(most + 1, 0.0);
  std::vector<double> next(most + 1, 0.0);
  chance[0] = 1.0;
  std::size_t reached = 0;
  for (const double rank : ranks) {
    const std::size_t step = scaled(rank);
    reached = std::min(reached + step, most);
    for (std::size_t sum = 0; sum < std::min(step, most + 1); ++sum) next[sum] = 0.5 * chance[sum];
    const double* const before = chance.data();
    double* const after = next.data();
    for (std::size_t sum = step; sum <= reached; ++sum) {
      after[sum] = 0.5 * (before[sum] + before[sum - step]);
    }
    std::swap(chance, next);
  }
  double smaller = 0.0;
  for (const double one : chance) smaller += one;
  const double larger = 1.0 - smaller + chance[most];
  return at == most ? Tails{smaller, larger} : Tails{larger, smaller};
}

/// Variance given the observed ranks, which is correct with ties and dropped zeros.
Tails normal_tails(const std::vector<double>& ranks, double t, bool continuity) {
  double center = 0.0;
  double variance = 0.0;
  for (const double rank : ranks) {
    center += 0.5 * rank;
    variance += 0.25 * rank * rank;
  }
  const double half = continuity ? 0.5 : 0.0;
  const double deviation = std::sqrt(variance);
  return {normal_cdf((t - center + half) / deviation), normal_cdf((center - t + half) / deviation)};
}

double chosen(const Tails& tails, Alternative alternative) {
  if (alternative == Alternative::less) return tails.lower;
  if (alternative == Alternative::greater) return tails.upper;
  return 2.0 * std::min(tails.lower, tails.upper);
}

}  // namespace

SignedRank signed_rank(std::span<const double> differences, const SignedRankOptions& options) {
  SignedRank out;
  // The bits of magnitudes are ordered as the magnitudes are, and leave room for the sign.
  std::vector<std::uint64_t> ordered;
  ordered.reserve(differences.size());
  for (const double difference : differences) {
    if (difference == 0.0) ++out.zeros;
    if (difference == 0.0 && options.zeros == Zeros::wilcoxon) continue;
    const auto magnitude = std::bit_cast<std::uint64_t>(std::abs(difference));
    ordered.push_back(magnitude << 1 | (difference > 0.0 ? 1 : 0));
  }
  std::ranges::sort(ordered);
  std::vector<double> ranks;  // of non-zero differences; ties get the mean of their ranks
  for (std::size_t begin = 0, end = 0; begin < ordered.size(); begin = end) {
    const std::uint64_t magnitude = ordered[begin] >> 1;
    while (end < ordered.size() && ordered[end] >> 1 == magnitude) ++end;
    if (magnitude == 0) continue;
    const double shared = 0.5 * static_cast<double>(begin + 1 + end);
    for (std::size_t i = begin; i < end; ++i) {
      ranks.push_back(shared);
      ((ordered[i] & 1) != 0 ? out.positive : out.negative) += shared;
    }
  }
  out.count = ranks.size();
  if (ranks.empty()) return out;
  out.is_exact = ranks.size() <= options.exact_up_to;
  const Tails tails = out.is_exact ? exact_tails(ranks, out.positive)
                                   : normal_tails(ranks, out.positive, options.continuity);
  out.p = std::min(1.0, chosen(tails, options.alternative));
  return out;
}

std::optional<std::size_t> critical_rank_sum(std::size_t n, double alpha) {
  const std::size_t most = n * (n + 1) / 4;
  if (n > SignedRankOptions{}.exact_up_to) {
    const auto count = static_cast<double>(n);
    const double center = 0.25 * count * (count + 1.0);
    const double deviation = std::sqrt(center * (2.0 * count + 1.0) / 6.0);
    const auto is_rejected = [&](std::size_t sum) {
      return 2.0 * normal_cdf((static_cast<double>(sum) + 0.5 - center) / deviation) <= alpha;
    };
    std::size_t low = 0;
    for (std::size_t high = most; low < high;) {  // the first sum that is not rejected
      const std::size_t middle = low + (high - low) / 2;
      if (is_rejected(middle)) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low == 0 ? std::nullopt : std::optional(low - 1);
  }
  std::vector<double> chance(most + 1, 0.0);
  chance[0] = 1.0;
  for (std::size_t rank = 1; rank <= n; ++rank) {
    for (std::size_t sum = most + 1; sum-- > 0;) {
      chance[sum] = 0.5 * (chance[sum] + (sum >= rank ? chance[sum - rank] : 0.0));
    }
  }
  double tail = 0.0;
  std::size_t sum = 0;
  while (sum <= most && 2.0 * (tail + chance[sum]) <= alpha) tail += chance[sum++];
  return sum == 0 ? std::nullopt : std::optional(sum - 1);
}

double least_p(std::size_t n) { return std::min(1.0, std::pow(2.0, 1.0 - static_cast<double>(n))); }

}  // namespace loopbench::harness
