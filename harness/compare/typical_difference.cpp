#include "harness/compare/typical_difference.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "harness/compare/signed_rank.hpp"

namespace loopbench::harness {
namespace {

/// Integers in the order of doubles.
std::int64_t rank_of(double value) {
  const auto bits = std::bit_cast<std::int64_t>(value);
  return bits >= 0 ? bits : std::numeric_limits<std::int64_t>::min() - bits;
}

double of_rank(std::int64_t rank) {
  return std::bit_cast<double>(rank >= 0 ? rank : std::numeric_limits<std::int64_t>::min() - rank);
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

double walsh_average(std::span<const double> sorted, std::size_t k) {
  const auto first = std::ranges::find_if(sorted, [](double v) { return v > -0.5 * kBeyond; });
  const auto last =
      std::ranges::find_if(first, sorted.end(), [](double v) { return v >= 0.5 * kBeyond; });
  const auto below = static_cast<std::size_t>(first - sorted.begin());
  const auto above = static_cast<std::size_t>(sorted.end() - last);
  const std::span<const double> finite(first, last);
  const std::size_t lowest = pairs(below) + below * finite.size() + below * above / 2;
  if (k <= lowest) return -kBeyond;
  if (k > lowest + pairs(finite.size())) return kBeyond;
  std::int64_t low = rank_of(finite.front());
  std::int64_t high = rank_of(finite.back());
  while (low < high) {
    const std::int64_t middle =
        low + static_cast<std::int64_t>(
                  (static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low)) / 2);
    if (means_up_to(finite, of_rank(middle)) >= k - lowest) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return of_rank(high);
}

double pseudo_median(std::span<const double> sorted) {
  const std::size_t count = pairs(sorted.size());
  const double lower = walsh_average(sorted, (count + 1) / 2);
  const double upper = walsh_average(sorted, count / 2 + 1);
  if (lower == -kBeyond || upper == kBeyond) {  // finite if one of the two is
    if (std::abs(lower) != kBeyond) return lower;
    return std::abs(upper) != kBeyond || lower == upper ? upper : 0.0;
  }
  return 0.5 * (lower + upper);
}

std::optional<Interval> shift_interval(std::span<const double> sorted, double alpha) {
  const std::optional<std::size_t> sum = critical_rank_sum(sorted.size(), alpha);
  if (!sum) return std::nullopt;
  return Interval{pseudo_median(sorted),
                  walsh_average(sorted, *sum + 1),
                  walsh_average(sorted, pairs(sorted.size()) - *sum)};
}

}  // namespace loopbench::harness
