#include "harness/answers/compare/typical.hpp"

#include <numeric>

namespace loopbench::harness {
namespace {

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

}  // namespace

double walsh_average(std::span<const double> sorted, std::size_t k) {
  const auto are_enough = [&](double most) { return means_up_to(sorted, most) >= k; };
  double low = sorted.front();
  double high = sorted.back();
  if (are_enough(low)) return low;
  for (double middle = std::midpoint(low, high); low < middle && middle < high;
       middle = std::midpoint(low, high)) {
    (are_enough(middle) ? high : low) = middle;
  }
  return high;
}

double pseudo_median(std::span<const double> sorted) {
  const std::size_t count = sorted.size() * (sorted.size() + 1) / 2;
  return 0.5 * (walsh_average(sorted, (count + 1) / 2) + walsh_average(sorted, count / 2 + 1));
}

}  // namespace loopbench::harness
