#include "harness/tables/mark_best.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace loopbench::harness {
namespace {

struct MarkContest {
  std::vector<std::size_t> entries;  // competitors with a value
  std::vector<bool> is_complete;     // per entry: has a value or failure on every run
  GroupedValues values;
  std::size_t groups = 0;
};

/// Numbers small numbers in order of appearance.
class Renumbered {
 public:
  std::size_t index(std::size_t number) {
    if (number >= index_.size()) index_.resize(number + 1, kNone);
    if (index_[number] == kNone) index_[number] = size_++;
    return index_[number];
  }
  std::size_t size() const { return size_; }

 private:
  static constexpr auto kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> index_;
  std::size_t size_ = 0;
};

/// Runs of any of the entries.
std::size_t count_runs(const MarkInput& input, const std::vector<std::size_t>& entries) {
  std::vector<bool> is_there(input.group.size(), false);
  for (const std::size_t i : entries) {
    for (const auto& [run, value] : input.competitors[i]) is_there[run] = true;
  }
  return static_cast<std::size_t>(std::ranges::count(is_there, true));
}

MarkContest mark_contest(const MarkInput& input) {
  MarkContest out;
  for (std::size_t i = 0; i < input.competitors.size(); ++i) {
    const ByRun& own = input.competitors[i];
    if (std::ranges::any_of(own, [](const auto& one) { return one.second.has_value(); })) {
      out.entries.push_back(i);
    }
  }
  const std::size_t runs = count_runs(input, out.entries);
  RunSet common;
  for (const std::size_t i : out.entries) {
    RunSet own;
    for (const auto& [run, value] : input.competitors[i]) own.insert(own.end(), run);
    out.is_complete.push_back(own.size() == runs);
    if (i == out.entries.front()) {
      common = std::move(own);
    } else {
      keep_only(common, own);
    }
  }
  Renumbered groups;
  for (const std::size_t run : common) out.values.group.push_back(groups.index(input.group[run]));
  for (const std::size_t i : out.entries) {
    const ByRun& own = input.competitors[i];
    const bool is_common = own.size() == common.size();
    std::vector<std::optional<double>>& values = out.values.values.emplace_back();
    values.reserve(common.size());
    for (const auto& [run, value] : own) {
      if (is_common || common.contains(run)) values.push_back(value);
    }
  }
  out.values.better = input.better;
  out.values.target = input.target;
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
