#include <algorithm>
#include <cmath>
#include <optional>

#include "harness/answers/compare/compare.hpp"

namespace loopbench::harness {
namespace {

/// Two methods of which the first is better with this p.
struct Order {
  double p = 1.0;
  std::size_t better = 0;
  std::size_t worse = 0;
  bool is_relevant = true;  ///< typically by a relevant difference, or by failures
};

/// The first method that each is equal to.
std::vector<std::size_t> first_equals(const Levels& levels) {
  std::vector<std::size_t> out;
  for (std::size_t m = 0; m < levels.methods(); ++m) {
    std::size_t first = 0;
    while (first < m && (out[first] != first || !levels.are_equal(m, first))) ++first;
    out.push_back(first);
  }
  return out;
}

std::optional<Order> order_of(const Pair& pair,
                              std::size_t first,
                              std::size_t second,
                              const CompareOptions& options) {
  if (!pair.has_difference() || !pair.is_significant(options.alpha)) return std::nullopt;
  Order out{pair.p, first, second};
  if (!pair.is_first_ahead()) std::swap(out.better, out.worse);
  const double beyond = pair.is_first_ahead() ? -kNoRatio : kNoRatio;
  out.is_relevant = !pair.is_ratio || std::abs(pair.typical()) >= std::log1p(options.relevant) ||
                    std::ranges::count(pair.values, beyond) > 0;
  return out;
}

/// The smallest p of `groups` groups, or of so many independent runs of each method and sequence.
double least_p_of(std::size_t groups, std::size_t strata) {
  if (strata == 0) return least_p(groups);
  return 2.0 * rank_sum_tail(std::vector<Stratum>(strata, {groups, groups}), 0);
}

}  // namespace

void rank_methods(const Levels& levels, Comparison& out) {
  const std::vector<std::size_t> equals = first_equals(levels);
  std::vector<std::size_t> different;
  for (std::size_t m = 0; m < equals.size(); ++m) {
    if (equals[m] == m) different.push_back(m);
  }
  std::vector<Order> orders;
  std::vector<std::size_t> rivals_beaten(levels.methods());
  std::size_t pairs = 0;
  std::size_t strata = 0;
  for (const std::size_t second : different) {
    for (const std::size_t first : different) {
      if (first >= second) break;
      const Pair pair = compared(levels, first, second);
      ++pairs;
      strata = std::max(strata, pair.strata.size());
      out.can_show = out.can_show || pair.least_p <= out.options.alpha;
      const auto order = order_of(pair, first, second, out.options);
      if (!order || out.methods[order->better].covers_less) continue;
      orders.push_back(*order);
      ++rivals_beaten[order->better];
    }
  }
  out.has_strata = strata > 0;
  out.tests = std::max<std::size_t>(1, different.size() - 1);
  out.groups_needed = 1;
  while (least_p_of(out.groups_needed, strata) > out.options.alpha) ++out.groups_needed;
  const auto best = std::ranges::max_element(rivals_beaten);
  const bool has_best = different.size() > 1 && *best + 1 == different.size();
  const auto best_method = static_cast<std::size_t>(best - rivals_beaten.begin());
  std::ranges::sort(orders, {}, &Order::p);
  std::size_t rejected = 0;
  for (const Order& order : orders) {
    const double level = out.options.alpha / static_cast<double>(pairs - rejected);
    if (has_best ? order.better != best_method : order.p > level) continue;
    ++rejected;
    if (order.is_relevant) out.methods[order.worse].is_worse = true;
  }
  out.is_best = has_best && std::ranges::any_of(out.methods, &MethodVerdict::is_worse);
  for (std::size_t m = 0; m < equals.size(); ++m)
    out.methods[m].is_worse = out.methods[equals[m]].is_worse;
}

void test_sequences(Comparison& c) {
  std::vector<SequenceRatio*> all;
  std::size_t sequences = 0;
  for (MethodVerdict& m : c.methods) {
    if (!m.ratio || m.method == c.options.baseline) continue;
    sequences = std::max(sequences, m.ratio->by_sequence.size());
    for (SequenceRatio& one : m.ratio->by_sequence) all.push_back(&one);
  }
  std::ranges::stable_sort(all, {}, &SequenceRatio::p);
  std::size_t left = c.tests * sequences;
  for (SequenceRatio* one : all) {
    if (one->p > c.options.alpha / static_cast<double>(std::max<std::size_t>(1, left))) break;
    one->is_clear = true;
    if (left > 0) --left;
  }
  for (MethodVerdict& m : c.methods) {
    if (!m.ratio) continue;
    const auto is_clear = [&](bool above) {
      return std::ranges::any_of(m.ratio->by_sequence, [&](const SequenceRatio& one) {
        return one.is_clear && (one.ratio > 1.0) == above;
      });
    };
    m.is_divided = is_clear(true) && is_clear(false);
    if (m.is_divided) m.beats_baseline = m.is_beaten = m.ratio->has_interval = false;
  }
}

}  // namespace loopbench::harness
