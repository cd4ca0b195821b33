#include <algorithm>
#include <cmath>
#include <optional>

#include "harness/compare/compare.hpp"
#include "harness/compare/signed_rank.hpp"

namespace loopbench::harness {
namespace {

/// Methods that differ from all before them, less one.
std::size_t count_tests(const Levels& levels) {
  std::vector<std::size_t> different;
  for (std::size_t m = 0; m < levels.methods(); ++m) {
    const auto is_copy = [&](std::size_t other) { return levels.are_equal(m, other); };
    if (std::ranges::none_of(different, is_copy)) different.push_back(m);
  }
  return std::max<std::size_t>(1, different.size() - 1);
}

/// Of the methods that were run on half of the groups or more, a method that is ahead of all others
/// is found in any order of them.
std::size_t find_leader(const Levels& levels) {
  constexpr double kMost = 0.5;
  std::vector<std::size_t> known;  // groups of each method
  for (std::size_t m = 0; m < levels.methods(); ++m) known.push_back(levels.known_groups(m));
  const auto most = static_cast<double>(std::ranges::max(known));
  std::optional<std::size_t> leader;
  for (std::size_t m = 0; m < known.size(); ++m) {
    if (static_cast<double>(known[m]) < kMost * most) continue;
    if (!leader || compared(levels, m, *leader).is_first_ahead()) leader = m;
  }
  return *leader;
}

Standing standing_of(const Pair& from_leader, std::size_t tests, const CompareOptions& options) {
  if (!from_leader.has_difference()) {
    return from_leader.values.empty() ? Standing::open : Standing::equal;
  }
  if (!from_leader.is_first_ahead() || !from_leader.is_significant(options.alpha, tests)) {
    return Standing::open;
  }
  const auto typical = from_leader.typical(level_of_one(options.alpha, tests));
  const bool is_near = from_leader.is_ratio && typical &&
                       -typical->estimate < std::log1p(options.relevant) &&
                       std::ranges::count(from_leader.values, -kNoRatio) == 0;
  return is_near ? Standing::near : Standing::behind;
}

/// The smallest p of `groups` groups, or of so many independent runs of each method and sequence.
double least_p_of(std::size_t groups, std::size_t strata) {
  if (strata == 0) return least_p(groups);
  return 2.0 * rank_sum_tail(std::vector<Stratum>(strata, {groups, groups}), 0);
}

}  // namespace

bool Ranking::is_best() const {
  return std::ranges::count(standings, Standing::open) == 0 &&
         std::ranges::any_of(
             standings, [](Standing s) { return s == Standing::behind || s == Standing::near; });
}

Ranking rank_methods(const Levels& levels, const CompareOptions& options) {
  Ranking out;
  out.tests = count_tests(levels);
  out.leader = find_leader(levels);
  out.standings.resize(levels.methods());
  out.from_leader.resize(levels.methods());
  std::size_t strata = 0;
  for (std::size_t m = 0; m < levels.methods(); ++m) {
    if (m == out.leader) continue;
    out.from_leader[m] = compared(levels, out.leader, m);
    out.standings[m] = standing_of(out.from_leader[m], out.tests, options);
    strata = std::max(strata, out.from_leader[m].strata.size());
    out.can_show =
        out.can_show || corrected(out.from_leader[m].least_p, out.tests) <= options.alpha;
  }
  out.standings[out.leader] = Standing::leader;
  while (corrected(least_p_of(out.groups_needed, strata), out.tests) > options.alpha) {
    ++out.groups_needed;
  }
  return out;
}

}  // namespace loopbench::harness
