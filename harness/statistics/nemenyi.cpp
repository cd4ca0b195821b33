#include "harness/statistics/nemenyi.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "harness/statistics/studentized_range.hpp"

namespace loopbench {

double critical_difference(std::size_t treatments, std::size_t blocks, double alpha) {
  if (blocks == 0) throw std::invalid_argument("a critical difference needs blocks");
  const auto k = static_cast<double>(treatments);
  const double q = range_quantile(1.0 - alpha, static_cast<int>(treatments)) / std::numbers::sqrt2;
  return q * std::sqrt(k * (k + 1.0) / (6.0 * static_cast<double>(blocks)));
}

std::vector<std::vector<std::size_t>> rank_groups(std::span<const double> average_ranks,
                                                  double difference) {
  std::vector<std::size_t> order(average_ranks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return average_ranks[i]; });
  std::vector<std::vector<std::size_t>> groups;
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < order.size(); ++begin) {
    const std::size_t before = end;
    while (end < order.size() &&
           average_ranks[order[end]] - average_ranks[order[begin]] <= difference) {
      ++end;
    }
    if (end == before || end - begin < 2) continue;  // within the group before, or alone
    const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
    groups.emplace_back(at(begin), at(end));
  }
  return groups;
}

}  // namespace loopbench
