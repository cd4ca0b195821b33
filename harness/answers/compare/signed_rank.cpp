#include "harness/answers/compare/signed_rank.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

namespace loopbench::harness {
namespace {

/// P(S = 0), ..., P(S = s) for the sum S of the scores with positive sign, which are whole numbers.
/// The distribution is symmetric, so that `s` up to half of the sum of all is enough.
std::vector<double> exact_chances(const std::vector<std::size_t>& scores, std::size_t s) {
  // Up to 53 scores all probabilities are multiples of 2^-53, without rounding.
  std::vector<double> chance(s + 1, 0.0);
  std::vector<double> next(s + 1, 0.0);
  chance[0] = 1.0;
  std::size_t reached = 0;
  for (const std::size_t step : scores) {
    reached = std::min(reached + step, s);
    for (std::size_t sum = 0; sum < std::min(step, s + 1); ++sum) next[sum] = 0.5 * chance[sum];
    const double* const before = chance.data();
    double* const after = next.data();
    for (std::size_t sum = step; sum <= reached; ++sum) {
      after[sum] = 0.5 * (before[sum] + before[sum - step]);
    }
    std::swap(chance, next);
  }
  return chance;
}

/// P(S <= 0), ..., P(S <= s), where `s` is the score of a sum `t` of `count` of the ranks. Midranks
/// are doubled to be integers; among equal sums of few ranks, more ranks are the larger score.
std::vector<double> exact_tails(const std::vector<double>& ranks, double t, std::size_t count) {
  const bool is_whole = std::ranges::all_of(ranks, [](double r) { return r == std::floor(r); });
  const bool is_ordered = ranks.size() <= kMostOrdered;
  const std::size_t weight = is_ordered ? ranks.size() + 1 : 1;
  const auto score = [&](double sum, std::size_t terms) {
    const auto whole = static_cast<std::size_t>(std::lround((is_whole ? 1.0 : 2.0) * sum));
    return weight * whole + (is_ordered ? terms : 0);
  };
  std::vector<std::size_t> scores;
  for (const double rank : ranks) scores.push_back(score(rank, 1));
  std::vector<double> out = exact_chances(scores, score(t, count));
  std::partial_sum(out.begin(), out.end(), out.begin());
  return out;
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

/// Number of means of two values up to `most`.
std::size_t means_up_to(std::span<const double> sorted, double most) {
  std::size_t count = 0;
  std::size_t end = sorted.size();
  for (std::size_t i = 0; i < end; ++i) {
    while (end > i && 0.5 * (sorted[i] + sorted[end - 1]) > most) --end;
    count += end - i;
  }
  return count;
}

std::size_t pairs(std::size_t n) { return n * (n + 1) / 2; }

}  // namespace

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

SignedRank signed_rank(std::span<const double> differences, std::size_t most_exact) {
  SignedRank out;
  std::vector<double> magnitudes;
  for (const double difference : differences) magnitudes.push_back(std::abs(difference));
  const std::vector<double> all = midranks(magnitudes);
  std::size_t positive = 0;   // number of positive differences
  std::vector<double> ranks;  // of non-zero differences
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (differences[i] == 0.0) continue;
    ranks.push_back(all[i]);
    (differences[i] > 0.0 ? out.positive : out.negative) += all[i];
    positive += differences[i] > 0.0 ? 1 : 0;
  }
  out.count = ranks.size();
  if (ranks.empty()) return out;
  const auto [smaller, count] =
      std::min(std::pair(out.positive, positive), std::pair(out.negative, out.count - positive));
  const bool is_exact = ranks.size() <= most_exact;
  const double tail =
      is_exact ? exact_tails(ranks, smaller, count).back() : normal_tail(ranks, smaller);
  out.p = std::min(1.0, 2.0 * tail);
  return out;
}

std::optional<std::size_t> critical_rank_sum(std::size_t n, double alpha) {
  std::vector<double> ranks(n);
  std::iota(ranks.begin(), ranks.end(), 1.0);
  const std::size_t most = n * (n + 1) / 4;
  const std::size_t weight = n <= kMostOrdered ? n + 1 : 1;  // scores as in exact_tails()
  std::vector<double> tails;
  if (n <= kMostExact) tails = exact_tails(ranks, static_cast<double>(most), n);
  return largest_rejected(most, alpha, [&](std::size_t sum) {
    return tails.empty() ? normal_tail(ranks, static_cast<double>(sum))
                         : tails[weight * (sum + 1) - 1];
  });
}

double least_p(std::size_t n) { return std::min(1.0, std::pow(2.0, 1.0 - static_cast<double>(n))); }

double walsh_average(std::span<const double> sorted, std::size_t k) {
  const auto first = std::ranges::find_if(sorted, [](double v) { return v > -0.5 * kNoRatio; });
  const auto last =
      std::ranges::find_if(first, sorted.end(), [](double v) { return v >= 0.5 * kNoRatio; });
  const auto below = static_cast<std::size_t>(first - sorted.begin());
  const auto above = static_cast<std::size_t>(sorted.end() - last);
  const std::span<const double> finite(first, last);
  const std::size_t lowest = pairs(below) + below * finite.size() + below * above / 2;
  if (k <= lowest) return -kNoRatio;
  if (k > lowest + pairs(finite.size())) return kNoRatio;
  const auto are_enough = [&](double most) { return means_up_to(finite, most) >= k - lowest; };
  double low = finite.front();
  double high = finite.back();
  if (are_enough(low)) return low;
  for (double middle = std::midpoint(low, high); low < middle && middle < high;
       middle = std::midpoint(low, high)) {
    (are_enough(middle) ? high : low) = middle;
  }
  return high;
}

double pseudo_median(std::span<const double> sorted) {
  const std::size_t count = pairs(sorted.size());
  const double lower = walsh_average(sorted, (count + 1) / 2);
  const double upper = walsh_average(sorted, count / 2 + 1);
  if (lower == -kNoRatio || upper == kNoRatio) {  // finite if one of the two is
    if (std::abs(lower) != kNoRatio) return lower;
    return std::abs(upper) != kNoRatio || lower == upper ? upper : 0.0;
  }
  return 0.5 * (lower + upper);
}

namespace {

/// The smallest shift that the test does not reject, given its critical sum.
double smallest_shift(std::span<const double> sorted, std::size_t critical, double alpha) {
  const double end = walsh_average(sorted, critical + 1);
  if (sorted.size() > kMostOrdered || std::abs(end) == kNoRatio) return end;
  // Up to the next mean the sum is one more, which the number of ranks can reject.
  const double next = walsh_average(sorted, critical + 2);
  std::vector<double> shifted(sorted.begin(), sorted.end());
  for (double& value : shifted) value -= 0.5 * (end + next);
  const bool has_next = end < next && next < kNoRatio;
  return has_next && signed_rank(shifted).p <= alpha ? next : end;
}

}  // namespace

std::optional<Interval> shift_interval(std::span<const double> sorted, double alpha) {
  const std::optional<std::size_t> sum = critical_rank_sum(sorted.size(), alpha);
  if (!sum) return std::nullopt;
  std::vector<double> mirrored(sorted.rbegin(), sorted.rend());
  for (double& value : mirrored) value = -value;
  return Interval{pseudo_median(sorted),
                  smallest_shift(sorted, *sum, alpha),
                  -smallest_shift(mirrored, *sum, alpha)};
}

}  // namespace loopbench::harness
