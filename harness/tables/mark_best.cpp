#include "harness/tables/mark_best.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "harness/compare/name_order.hpp"

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
  std::set<std::string> runs;
  for (std::size_t i = 0; i < input.competitors.size(); ++i) {
    const ByRun& own = input.competitors[i];
    if (std::ranges::none_of(own, [](const auto& run) { return run.second.has_value(); })) continue;
    out.entries.push_back(i);
    for (const auto& [run, value] : own) runs.insert(run);
  }
  NameOrder groups;
  out.values.values.resize(out.entries.size());
  out.values.better = input.better;
  out.values.target = input.target;
  for (const std::size_t i : out.entries) {
    out.is_complete.push_back(input.competitors[i].size() == runs.size());
  }
  for (const std::string& run : runs) {
    const auto has_run = [&](std::size_t i) { return input.competitors[i].contains(run); };
    if (!std::ranges::all_of(out.entries, has_run)) continue;
    for (std::size_t e = 0; e < out.entries.size(); ++e) {
      out.values.values[e].push_back(input.competitors[out.entries[e]].at(run));
    }
    const auto group = input.group.find(run);
    out.values.group.push_back(groups.index(group == input.group.end() ? run : group->second));
  }
  out.groups = groups.names().size();
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
  if (is_surely_unproven(all.values, options)) return out;
  const Ranking ranking = rank_methods(all.values, options);
  if (ranking.pairs > 0 && !ranking.can_prove(options.alpha)) {
    out.why_none = fmt::format("{} independent run{} per entry cannot prove a difference at {:g}",
                               all.groups,
                               all.groups == 1 ? "" : "s",
                               options.alpha);
    return out;
  }
  if (!ranking.is_best_proven()) return out;
  const auto mark = [&](std::size_t entry, Mark value) {
    if (all.is_complete[entry]) out.marks[all.entries[entry]] = value;
  };
  const std::vector<std::size_t> best = ranking.leaders();
  for (const std::size_t entry : best) mark(entry, Mark::best);
  if (best.size() + 1 >= all.entries.size()) return out;
  const std::size_t next = ranking.order[best.size()];
  const auto is_below = [&](std::size_t m) {
    return m == next || ranking.beats[next][m] || ranking.beats[m][next];
  };
  if (std::ranges::all_of(ranking.order, is_below)) mark(next, Mark::second);
  return out;
}

}  // namespace loopbench::harness
