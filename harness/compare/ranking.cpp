#include "harness/compare/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <future>
#include <numeric>
#include <thread>

#include "harness/statistics/holm.hpp"

namespace loopbench::harness {
namespace {

struct Test {
  std::size_t a = 0;
  std::size_t b = 0;
  PairedMethods pair;
  SignedRank ranks;
  double p = 1.0;  // corrected
};

/// A 95 % interval misses the mean in up to 7 % of the cases (mean_interval.hpp), so that its p
/// counts 7 / 5 times.
constexpr double kMissesPerNominal = 1.4;

bool has_failure(const PairedMethods& pair) {
  return std::ranges::any_of(pair.losses_last,
                             [](double value) { return std::abs(value) == kBeyond; });
}

/// Whether the mean ratio agrees with the ranks; raises p to that of its interval, with a margin.
bool mean_agrees(Test& test, bool is_ratio, const RankingOptions& options) {
  const std::optional<double> middle = mean_difference(test.pair);
  if (!middle) return true;  // a failure or a zero error decides
  const double least = is_ratio ? std::log1p(options.relevant) : 0.0;
  const bool a_is_better = test.ranks.negative > test.ranks.positive;
  const double gain = a_is_better ? -*middle : *middle;
  if (std::abs(gain) <= least) return has_failure(test.pair);  // equal where both have a value
  if (gain < 0.0) return false;
  const auto interval = mean_interval(test.pair.common, 1.0 - options.alpha);
  if (interval) test.p = std::max(test.p, std::min(1.0, kMissesPerNominal * interval->p));
  return test.p <= options.alpha;
}

void decide(Ranking& out, Test& test, bool is_ratio, const RankingOptions& options) {
  const bool a_is_better = test.ranks.negative > test.ranks.positive;
  const std::size_t winner = a_is_better ? test.a : test.b;
  const std::size_t loser = a_is_better ? test.b : test.a;
  const bool is_significant = out.can_prove(options.alpha) && test.p <= options.alpha;
  if (is_significant && mean_agrees(test, is_ratio, options)) {
    out.beats[winner][loser] = true;
  } else if (test.p <= options.alpha) {
    test.p = 1.0;  // ranks and ratio contradict each other: not significant
  }
  out.p[test.a][test.b] = out.p[test.b][test.a] = test.p;
}

std::vector<double> standings_of(const Levels& levels) {
  std::vector<double> out;
  for (std::size_t m = 0; m < levels.methods(); ++m) out.push_back(levels.standing(m));
  return out;
}

std::vector<std::size_t> order_of(const std::vector<double>& standings) {
  std::vector<std::size_t> out(standings.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  std::ranges::stable_sort(out, {}, [&](std::size_t m) { return standings[m]; });
  return out;
}

/// By standing, but never before a method that beats it. (Of methods that beat each other in a
/// circle, the best standing is first.)
void follow_claims(Ranking& out) {
  std::vector<std::size_t> left = out.order;
  for (std::size_t& next : out.order) {
    const auto is_unbeaten = [&](std::size_t m) {
      return std::ranges::none_of(left, [&](std::size_t other) { return out.beats[other][m]; });
    };
    auto found = std::ranges::find_if(left, is_unbeaten);
    if (found == left.end()) found = left.begin();
    next = *found;
    left.erase(found);
  }
}

/// Whether claims can contradict the standings: only failures and errors of zero, which have no
/// ratio, allow that.
bool has_failure_or_zero(const GroupedValues& all) {
  const double target = all.better == metrics::Better::target ? all.target : 0.0;
  const auto is_one = [&](const std::optional<double>& value) {
    return !value || std::abs(*value - target) <= zero_floor(1.0);
  };
  return std::ranges::any_of(all.values,
                             [&](const auto& row) { return std::ranges::any_of(row, is_one); });
}

/// Calls each(0) to each(count - 1), on several threads if there is much to do.
template <class Each>
void for_all(std::size_t count, std::size_t groups, Each each) {
  constexpr std::size_t kFewPairs = 100'000;  // pairs of values, less than a thread costs
  const std::size_t threads =
      count * groups < kFewPairs ? 1 : std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::future<void>> others;
  for (std::size_t t = 0; t < threads; ++t) {
    const auto part = [=] {
      for (std::size_t i = t; i < count; i += threads) each(i);
    };
    others.push_back(
        std::async(t + 1 < threads ? std::launch::async : std::launch::deferred, part));
  }
  for (auto other = others.rbegin(); other != others.rend(); ++other) other->get();
}

std::vector<Test> tests(const Levels& levels, Ranking& out) {
  std::vector<Test> all;
  for (std::size_t a = 0; a < levels.methods(); ++a) {
    for (std::size_t b = a + 1; b < levels.methods(); ++b) all.push_back({a, b, {}, {}, 1.0});
  }
  for_all(all.size(), levels.groups(), [&](std::size_t i) {
    all[i].pair = paired(levels, all[i].a, all[i].b);
    all[i].ranks = signed_rank(all[i].pair.losses_last);
  });
  std::vector<Test> found;
  std::size_t groups = 0;
  for (Test& test : all) {
    groups = std::max(groups, test.pair.losses_last.size());
    if (test.ranks.count == 0) {
      out.equal[test.a][test.b] = out.equal[test.b][test.a] = true;
    } else {
      found.push_back(std::move(test));
    }
  }
  out.pairs = found.size();
  if (groups >= out.groups_needed) {
    out.least_p = std::min(1.0, least_p(groups) * static_cast<double>(out.pairs));
  }
  return found;
}

}  // namespace

bool is_surely_unproven(const GroupedValues& values, const RankingOptions& options) {
  if (has_failure_or_zero(values)) return false;
  const Levels levels(values, options.relevant);
  const std::vector<std::size_t> order = order_of(standings_of(levels));
  const std::size_t first = order.front();
  const auto k = static_cast<double>(order.size());
  std::vector<double> p;  // of the tests against the first
  for (const std::size_t other : order) {
    if (other == first) continue;
    const PairedMethods pair = paired(levels, std::min(first, other), std::max(first, other));
    const std::size_t groups = pair.losses_last.size();
    if (groups < kFewestForInterval || least_p(groups) * 0.5 * k * (k - 1.0) > options.alpha) {
      return false;
    }
    const SignedRank ranks = signed_rank(pair.losses_last);
    if (ranks.count > 0 && ranks.p > options.alpha) return true;
    if (ranks.count > 0) p.push_back(ranks.p);
  }
  // Holm multiplies each p by at least the number of those that are not smaller.
  std::ranges::sort(p, std::greater<>());
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (static_cast<double>(i + 1) * p[i] > options.alpha) return true;
  }
  return false;
}

Ranking rank_methods(const GroupedValues& values, const RankingOptions& options) {
  const Levels levels(values, options.relevant);
  const std::size_t k = levels.methods();
  Ranking out;
  out.beats.assign(k, std::vector<bool>(k));
  out.equal.assign(k, std::vector<bool>(k));
  out.p.assign(k, std::vector<double>(k, 1.0));
  out.order = order_of(standings_of(levels));

  std::vector<Test> all = tests(levels, out);
  std::vector<double> p;
  for (const Test& test : all) p.push_back(test.ranks.p);
  const std::vector<double> adjusted = holm(p);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].p = adjusted[i];
    decide(out, all[i], levels.is_ratio(), options);
  }
  follow_claims(out);
  while (least_p(out.groups_needed) * static_cast<double>(out.pairs) > options.alpha) {
    ++out.groups_needed;
  }
  return out;
}

std::vector<std::size_t> Ranking::leaders() const {
  std::vector<std::size_t> out;
  for (const std::size_t m : order) {
    if (m == order.front() || equal[order.front()][m]) out.push_back(m);
  }
  return out;
}

bool Ranking::is_best_proven() const {
  const std::size_t first = order.front();
  return pairs > 0 && std::ranges::all_of(order, [&](std::size_t m) {
           return m == first || equal[first][m] || beats[first][m];
         });
}

std::size_t Ranking::lowest_rank(std::size_t method) const {
  return 1 + static_cast<std::size_t>(
                 std::ranges::count_if(order, [&](std::size_t m) { return beats[m][method]; }));
}

std::size_t Ranking::highest_rank(std::size_t method) const {
  return order.size() - static_cast<std::size_t>(std::ranges::count(beats[method], true));
}

}  // namespace loopbench::harness
