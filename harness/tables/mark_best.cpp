#include "harness/tables/mark_best.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

namespace loopbench::harness {
namespace {

struct MarkContest {
  std::vector<std::size_t> entries;  // competitors with a value
  std::vector<bool> is_complete;     // per entry: has a value or failure on every run
  GroupedValues values;
  std::size_t groups = 0;
};

MarkContest mark_contest(const MarkInput& input) {
  MarkContest out;
  std::set<std::size_t> runs;
  for (std::size_t i = 0; i < input.competitors.size(); ++i) {
    const ByRun& own = input.competitors[i];
    if (std::ranges::none_of(own, [](const auto& one) { return one.second.has_value(); })) continue;
    out.entries.push_back(i);
    for (const auto& [run, value] : own) runs.insert(run);
  }
  std::map<std::size_t, std::size_t> groups;
  for (const std::size_t run : runs) {
    out.values.group.push_back(groups.emplace(input.group[run], groups.size()).first->second);
    if (!input.sequence.empty()) out.values.sequence.push_back(input.sequence[run]);
  }
  for (const std::size_t i : out.entries) {
    const ByRun& own = input.competitors[i];
    out.is_complete.push_back(!input.is_paired || own.size() == runs.size());
    std::vector<std::optional<double>>& values = out.values.values.emplace_back();
    values.reserve(runs.size());
    auto next = own.begin();
    for (const std::size_t run : runs) {
      const bool is_known = next != own.end() && next->first == run;
      values.push_back(is_known ? std::optional(next->second.value_or(kFailed)) : std::nullopt);
      if (is_known) ++next;
    }
  }
  out.values.better = input.better;
  out.values.target = input.target;
  out.values.is_paired = input.is_paired;
  out.groups = groups.size();
  return out;
}

}  // namespace

const char* mark_name(Mark mark) {
  return mark == Mark::best ? "best" : mark == Mark::second ? "second" : "";
}

Marks mark_best(const MarkInput& input, const RankingOptions& options) {
  Marks out{std::vector<Mark>(input.competitors.size(), Mark::none), ""};
  const MarkContest all = mark_contest(input);
  if (all.entries.size() < 2 || all.groups == 0) return out;
  const Levels levels(all.values, options.tie);
  const Ranking ranking = rank_methods(levels, options);
  const bool has_difference = std::ranges::any_of(
      ranking.from_leader, [](const Pair& pair) { return pair.has_difference(); });
  if (has_difference && !ranking.can_show) {
    out.why_none = fmt::format("{} independent run{} per entry cannot show a difference at {:g}",
                               all.groups,
                               all.groups == 1 ? "" : "s",
                               options.alpha);
    return out;
  }
  if (!ranking.is_best()) return out;
  const auto mark = [&](const Ranking& place, Mark value) {
    for (std::size_t m = 0; m < all.entries.size(); ++m) {
      if (place.is_leading(m) && all.is_complete[m]) out.marks[all.entries[m]] = value;
    }
  };
  mark(ranking, Mark::best);
  const auto rest = std::ranges::count(ranking.standings, Standing::behind);
  if (rest == 0 || all.entries.size() == 2) return out;
  const Ranking others = rank_rest(levels, ranking, options);
  if (rest == 1 || others.is_best()) mark(others, Mark::second);
  return out;
}

}  // namespace loopbench::harness
