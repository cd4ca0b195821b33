#include "harness/compare/ranks.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace loopbench::harness {

bool tied(double a, double b, double tie) {
  return std::abs(a - b) <= tie * std::max(std::abs(a), std::abs(b));
}

std::vector<double> midranks(std::span<const double> values, double tie) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    end = begin + 1;
    while (end < order.size() && tied(values[order[end - 1]], values[order[end]], tie)) ++end;
    const double shared = 0.5 * static_cast<double>(begin + 1 + end);
    for (std::size_t i = begin; i < end; ++i) ranks[order[i]] = shared;
  }
  return ranks;
}

}  // namespace loopbench::harness
