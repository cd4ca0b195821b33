#include "metrics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

namespace loopbench {
namespace {

/// Pairwise: rounding grows with log(n) instead of n, at the price of plain summation.
template <class Term>
double sum(std::span<const double> values, Term term) {
  if (values.size() <= 128) {
    double total = 0.0;
    for (const double value : values) total += term(value);
    return total;
  }
  const std::size_t half = values.size() / 2;
  return sum(values.first(half), term) + sum(values.subspan(half), term);
}

/// Reorders `values`. The mean of the middle two for an even count.
double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*std::max_element(values.begin(), middle) + *middle);
}

}  // namespace

Statistics statistics(std::vector<double> errors, int ddof) {
  if (errors.empty()) throw std::invalid_argument("statistics of an empty list");
  const auto n = static_cast<double>(errors.size());
  Statistics out;
  out.count = errors.size();
  out.sse = sum(errors, [](double e) { return e * e; });
  if (!std::isfinite(out.sse)) throw std::runtime_error("an error or its square is not finite");
  out.mean = sum(errors, [](double e) { return e; }) / n;
  out.rmse = std::sqrt(out.sse / n);
  const double free = n - ddof;
  const double spread = sum(errors, [&](double e) { return (e - out.mean) * (e - out.mean); });
  out.std = free > 0.0 ? std::sqrt(spread / free) : 0.0;
  const auto [low, high] = std::minmax_element(errors.begin(), errors.end());
  out.min = *low;
  out.max = *high;
  out.median = median(errors);
  return out;
}

}  // namespace loopbench
