#include "metrics/numerics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "datasets/core/parallel.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::metrics {
namespace {

/// Pairwise summation: rounding grows with log(n) instead of n at the cost of a plain sum. The
/// blocks do not depend on the number of threads, so the result is reproducible.
template <class Total, class Block>
Total pairwise(std::span<const double> values,
               const Block& block,
               std::size_t threads = hardware_threads()) {
  if (values.size() <= 128) return block(values);
  const std::size_t half = values.size() / 2;
  const std::span<const double> halves[] = {values.first(half), values.subspan(half)};
  if (threads < 2 || half < kMinItemsPerThread) {
    const Total first = pairwise<Total>(halves[0], block, 1);
    return first + pairwise<Total>(halves[1], block, 1);
  }
  Total totals[2];
  parallel_invoke(
      2, [&](std::size_t i) { totals[i] = pairwise<Total>(halves[i], block, threads / 2); });
  return totals[0] + totals[1];
}

struct Sums {
  double plain = 0.0;
  double squares = 0.0;
  double min = 0.0;
  double max = 0.0;
};

Sums operator+(const Sums& a, const Sums& b) {
  return {a.plain + b.plain, a.squares + b.squares, std::min(a.min, b.min), std::max(a.max, b.max)};
}

Sums sums_of_block(std::span<const double> values) {
  Sums out{0.0, 0.0, values[0], values[0]};
  for (const double value : values) {
    out.plain += value;
    out.squares += value * value;
    out.min = std::min(out.min, value);
    out.max = std::max(out.max, value);
  }
  return out;
}

/// Reorders the values. O(n).
void set_percentiles(std::vector<double>& values, Statistics& out) {
  auto from = values.begin();
  for (const auto& [name, percentile, share] : kStatisticFields) {
    if (share == 0.0) continue;
    const double rank = share * static_cast<double>(values.size() - 1);
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(from, at, values.end());
    const double next = at + 1 == values.end() ? *at : *std::min_element(at + 1, values.end());
    out.*percentile = std::lerp(*at, next, rank - std::floor(rank));
    from = at;
  }
}

}  // namespace

Statistics statistics(std::vector<double> errors, int ddof) {
  if (errors.empty()) throw std::invalid_argument("statistics of an empty list");
  const auto n = static_cast<double>(errors.size());
  const Sums sums = pairwise<Sums>(errors, sums_of_block);
  if (!std::isfinite(sums.squares))
    throw std::runtime_error("an error or its square is not finite");
  Statistics out;
  out.count = errors.size();
  out.sse = sums.squares;
  out.mean = sums.plain / n;
  out.rmse = std::sqrt(out.sse / n);
  out.min = sums.min;
  out.max = sums.max;
  const auto squares_about_mean = [mean = out.mean](std::span<const double> values) {
    double total = 0.0;
    for (const double value : values) total += (value - mean) * (value - mean);
    return total;
  };
  const double degrees_of_freedom = n - ddof;
  const double squares = pairwise<double>(errors, squares_about_mean);
  out.std = degrees_of_freedom > 0.0 ? std::sqrt(squares / degrees_of_freedom) : 0.0;
  out.median = median(errors);
  set_percentiles(errors, out);
  return out;
}

}  // namespace loopbench::metrics
