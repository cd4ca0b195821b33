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
      if (is_common || common.contains(run))
        values.push_back(value ? value : std::optional(kFailed));
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
  const Levels levels(all.values, options.tie);
  const Ranking ranking = rank_methods(levels, options);
  const bool has_difference = std::ranges::any_of(
      ranking.from_leader, [](const Pair& pair) { return pair.ranks.count > 0; });
  if (has_difference && !ranking.can_show()) {
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
