#include "harness/compare/signed_rank.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

namespace loopbench::harness {
namespace {

/// P(T <= t), T being the sum of the ranks with positive sign. The distribution is symmetric, so
/// that `t` up to half of the sum of all is enough.
double exact_tail(const std::vector<double>& ranks, double t) {
  // Midranks are doubled to be integers. Up to 53 ranks all probabilities are multiples of 2^-53,
  // without rounding.
  const bool is_whole = std::ranges::all_of(ranks, [](double r) { return r == std::floor(r); });
  const double scale = is_whole ? 1.0 : 2.0;
  const auto most = static_cast<std::size_t>(std::lround(scale * t));
  std::vector<double> chance(most + 1, 0.0);
  std::vector<double> next(most + 1, 0.0);
  chance[0] = 1.0;
  std::size_t reached = 0;
  for (const double rank : ranks) {
    const auto step = static_cast<std::size_t>(std::lround(scale * rank));
    reached = std::min(reached + step, most);
    for (std::size_t sum = 0; sum < std::min(step, most + 1); ++sum) next[sum] = 0.5 * chance[sum];
    const double* const before = chance.data();
    double* const after = next.data();
    for (std::size_t sum = step; sum <= reached; ++sum) {
      after[sum] = 0.5 * (before[sum] + before[sum - step]);
    }
    std::swap(chance, next);
  }
  return std::accumulate(chance.begin(), chance.end(), 0.0);
}

/// Variance given the observed ranks, which is correct with ties and dropped zeros.
double normal_tail(const std::vector<double>& ranks, double t) {
  double center = 0.0;
  double variance = 0.0;
  for (const double rank : ranks) {
    center += 0.5 * rank;
    variance += 0.25 * rank * rank;
  }
  return normal_cdf((t + 0.5 - center) / std::sqrt(variance));
}

}  // namespace

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

SignedRank signed_rank(std::span<const double> differences, std::size_t most_exact) {
  SignedRank out;
  // The bits of magnitudes are ordered as the magnitudes are, and leave room for the sign.
  std::vector<std::uint64_t> ordered;
  ordered.reserve(differences.size());
  for (const double difference : differences) {
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
  const double smaller = std::min(out.positive, out.negative);
  const bool is_exact = ranks.size() <= most_exact;
  out.p =
      std::min(1.0, 2.0 * (is_exact ? exact_tail(ranks, smaller) : normal_tail(ranks, smaller)));
  return out;
}

std::optional<std::size_t> critical_rank_sum(std::size_t n, double alpha) {
  std::vector<double> ranks(n);
  std::iota(ranks.begin(), ranks.end(), 1.0);
  return largest_rejected(n * (n + 1) / 4, alpha, [&](std::size_t sum) {
    const auto t = static_cast<double>(sum);
    return n <= kMostExact ? exact_tail(ranks, t) : normal_tail(ranks, t);
  });
}

double least_p(std::size_t n) { return std::min(1.0, std::pow(2.0, 1.0 - static_cast<double>(n))); }

}  // namespace loopbench::harness
