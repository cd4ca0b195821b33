#include "metrics/median.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace loopbench {
namespace {

constexpr int kBits = 14;  // sign, exponent and 2 bits of mantissa: four buckets an octave

/// Never decreases with the value.
std::size_t bucket(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  constexpr std::uint64_t kSign = std::uint64_t{1} << 63;
  return ((bits & kSign) != 0 ? ~bits : bits | kSign) >> (64 - kBits);
}

/// Of the value with `rank` smaller or equal ones before it, the bucket; the count of values in
/// lower buckets is taken off `rank`.
std::size_t bucket_of_rank(const std::vector<std::size_t>& counts, std::size_t& rank) {
  std::size_t at = 0;
  for (; rank >= counts[at]; ++at) rank -= counts[at];
  return at;
}

}  // namespace

double median(std::span<const double> values) {
  std::size_t lower = (values.size() - 1) / 2;
  std::vector<double> middle;
  constexpr std::size_t kFew = 4096;  // counting costs more than it spares
  if (values.size() <= kFew) {
    middle.assign(values.begin(), values.end());
  } else {
    std::vector<std::size_t> counts(std::size_t{1} << kBits);
    for (const double value : values) ++counts[bucket(value)];
    std::size_t upper = values.size() / 2;
    const std::size_t first = bucket_of_rank(counts, lower);
    const std::size_t last = bucket_of_rank(counts, upper);
    for (const double value : values) {
      const std::size_t at = bucket(value);
      if (first <= at && at <= last) middle.push_back(value);
    }
  }
  const auto at = middle.begin() + static_cast<std::ptrdiff_t>(lower);
  std::nth_element(middle.begin(), at, middle.end());
  if (values.size() % 2 == 1) return *at;
  return 0.5 * (*at + *std::min_element(at + 1, middle.end()));
}

}  // namespace loopbench
