/// Tail of a sum over all exchanges of two methods.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "harness/answers/compare/distributions.hpp"

namespace loopbench::harness {

/// All values of one independent term of a sum, equally probable.
using Term = std::vector<double>;

/// Logarithm of the number of ways to choose the first of two samples of these sizes.
inline double log2_of_choices(std::size_t first, std::size_t second) {
  const auto a = static_cast<double>(first);
  const auto b = static_cast<double>(second);
  return (std::lgamma(a + b + 1.0) - std::lgamma(a + 1.0) - std::lgamma(b + 1.0)) / std::log(2.0);
}

/// All sums of one value of each term, in any order.
inline std::vector<double> sums_of(std::span<const Term> terms) {
  std::vector<double> out{0.0};
  for (const Term& term : terms) {
    std::vector<double> next;
    next.reserve(out.size() * term.size());
    for (const double value : term) {
      for (const double sum : out) next.push_back(sum + value);
    }
    out = std::move(next);
  }
  return out;
}

/// P(sum >= least), exact. O(m log m) for m = exchanges of the larger half of the terms.
inline double tail_of_terms(std::vector<Term> terms, double least) {
  std::ranges::stable_sort(terms, {}, [](const Term& term) { return term.size(); });
  // The last term can be as large as all others together.
  double all = 0.0, taken = 0.0;
  for (const Term& term : terms) all += std::log2(static_cast<double>(term.size()));
  std::size_t half = terms.size();
  while (half > 0 && taken < 0.5 * all - 1e-9) {
    taken += std::log2(static_cast<double>(terms[--half].size()));
  }
  std::vector<double> a = sums_of(std::span(terms).first(half));
  std::vector<double> b = sums_of(std::span(terms).subspan(half));
  std::ranges::sort(a);
  std::ranges::sort(b);
  double count = 0.0;
  std::size_t reached = b.size();
  for (const double sum : a) {
    while (reached > 0 && sum + b[reached - 1] >= least) --reached;
    count += static_cast<double>(b.size() - reached);
  }
  return count / (static_cast<double>(a.size()) * static_cast<double>(b.size()));
}

/// P(sum of +-sizes >= least) for many fair signs, by the saddlepoint approximation (Lugannani and
/// Rice, 1980); `least` is positive. O(n) per iteration.
inline double tail_of_signs(std::span<const double> sizes, double least) {
  double variance = 0.0, largest = 0.0;
  for (const double size : sizes) {
    variance += size * size;
    largest += size;
  }
  const double least_tail = std::exp2(-static_cast<double>(sizes.size()));
  const double z = least / std::sqrt(variance);
  if (z < 0.05) return normal_cdf(-z);
  if (least >= largest * (1.0 - 1e-9)) return least_tail;
  double low = 0.0, high = 0.0, at = least / variance, slope = 0.0;  // of the derivative's root
  for (int step = 0; step < 100; ++step) {
    double sum = -least;
    slope = 0.0;
    for (const double size : sizes) {
      const double tanh = std::tanh(at * size);
      sum += size * tanh;
      slope += size * size * (1.0 - tanh * tanh);
    }
    (sum > 0.0 ? high : low) = at;
    const double newton = at - sum / slope;
    const bool is_between = newton > low && (high == 0.0 || newton < high);
    double next = is_between ? newton : 0.5 * (low + high);
    if (!is_between && high == 0.0) next = 2.0 * at;
    const double change = std::abs(next - at);
    at = next;
    if (change <= 1e-8 * at) break;
  }
  double cumulant = 0.0;
  for (const double size : sizes) {
    const double x = at * size;
    cumulant += x + std::log1p(std::exp(-2.0 * x)) - std::log(2.0);
  }
  const double w = std::sqrt(2.0 * (at * least - cumulant));
  const double v = at * std::sqrt(slope);
  const double density = std::exp(-0.5 * w * w) / std::sqrt(2.0 * std::numbers::pi);
  return std::clamp(normal_cdf(-w) + density * (1.0 / v - 1.0 / w), least_tail, 1.0);
}

}  // namespace loopbench::harness
