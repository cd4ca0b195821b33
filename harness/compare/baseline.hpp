/// Reviewed numbers of a sweep: the reference of `loopbench check`.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/model/where.hpp"

namespace loopbench::harness {

/// Limit on the change of a number: it is a regression if worse by more than absolute + relative *
/// |baseline|. Scores without a direction are limited in both directions.
struct Tolerance {
  std::vector<std::string> where;                  ///< filters, see model/where; empty: every score
  std::vector<std::string> values{"rmse", "max"};  ///< compared statistics
  double relative = 0.001;                         ///< [-]
  double absolute = 1e-6;                          ///< in the unit of the score
};

/// The numbers of one sweep, with the definitions of its labels.
struct Snapshot {
  std::string sweep;
  std::string machine;                           ///< compiler, C library and CPU of all cells
  std::map<std::string, std::string> sequences;  ///< label -> all options, hashes of files
  std::map<std::string, std::string> contents;   ///< label -> hash of problem and reference
  std::map<std::string, std::string> protocols;  ///< label and version -> every rule
  std::map<std::string, std::string> metrics;    ///< label -> name, all options
  std::map<std::string, std::string> methods;    ///< label -> stages, all options
  /// Neighbours belong to one cell. A cell without checked scores has one record without a score.
  std::vector<Record> records;
};

/// Largest error of the numbers in a baseline: absolute + relative * |number|.
struct Rounding {
  double relative = 0.0;  ///< [-]
  double absolute = 0.0;  ///< in the unit of the score
};

struct Baseline {
  std::map<std::string, std::string>
      build_summary;                           ///< version, compiler, commit, source clean or dirty
  std::vector<Tolerance> limits{Tolerance{}};  ///< the first whose `where` matches a score applies
  Snapshot snapshot;
};

/// All statistics that have a limit.
inline std::vector<std::string> compared_statistics(const std::vector<Tolerance>& limits) {
  std::vector<std::string> out;
  for (const Tolerance& limit : limits) {
    for (const std::string& statistic : limit.values) {
      if (std::ranges::count(out, statistic) == 0) out.push_back(statistic);
    }
  }
  return out;
}

/// Metrics of measured times, which differ between runs of one build.
inline constexpr std::array kMeasuredTimes{"time", "update_time"};

inline bool is_measured_time(const Record& score) {
  return std::ranges::count(kMeasuredTimes, score.kind->metric) > 0;
}

/// Limits for times, compared between runs on the same CPU: a cell's median wall time [ms], and the
/// times of its updates [s] (neither their growth nor missed deadlines).
inline std::vector<Tolerance> time_limits(double relative) {
  const Tolerance of_cells{
      .where = {"metric=time"}, .values = {"rmse"}, .relative = relative, .absolute = 1.0};
  Tolerance of_updates = of_cells;
  of_updates.where = {"metric=update_time", "unit=s"};
  of_updates.absolute = 0.001;
  return {of_cells, of_updates};
}

/// Whether a limit is about times: its `where` names one of their metrics. Scores of these metrics
/// that no such limit selects are not checked.
inline bool limits_time(const Tolerance& limit) {
  return std::ranges::any_of(kMeasuredTimes, [&](const std::string& metric) {
    return std::ranges::count(limit.where, "metric=" + metric) > 0;
  });
}

inline bool limits_time(const std::vector<Tolerance>& limits) {
  return std::ranges::any_of(limits, [](const Tolerance& limit) { return limits_time(limit); });
}

/// A function that returns whether a score is checked: every score except a measured time without a
/// limit about times.
inline std::function<bool(const Record&)> is_checked(const std::vector<Tolerance>& limits) {
  std::vector<std::function<bool(const Record&)>> of_times;
  for (const Tolerance& limit : limits) {
    if (limits_time(limit)) of_times.push_back(where(limit.where));
  }
  return [of_times](const Record& score) {
    return !is_measured_time(score) ||
           std::ranges::any_of(of_times, [&](const auto& selects) { return selects(score); });
  };
}

/// Whether some of its cells were computed by a build with uncommitted changes.
inline bool is_dirty(const std::map<std::string, std::string>& build_summary) {
  const auto source = build_summary.find("source");
  return source != build_summary.end() && source->second.find("dirty") != std::string::npos;
}

/// The neighbours that belong to one cell.
inline std::vector<std::span<const Record>> by_cell(const std::vector<Record>& records) {
  const auto is_same = [](const CellRow& a, const CellRow& b) {
    return a.sequence == b.sequence && a.repeat == b.repeat && a.method == b.method;
  };
  std::vector<std::span<const Record>> out;
  for (std::size_t end = 0, begin = 0; end < records.size(); begin = end) {
    while (end < records.size() && is_same(*records[begin].cell, *records[end].cell)) ++end;
    out.emplace_back(&records[begin], end - begin);
  }
  return out;
}

/// The checked ones of a store's records, for a snapshot. O(n log n).
inline std::vector<Record> checked_records(std::vector<Record> records,
                                           const std::vector<Tolerance>& limits) {
  const auto is_kept = is_checked(limits);
  const auto position = [](const Record& r) { return r.cell->position; };
  std::ranges::stable_sort(records, {}, position);  // derived ones are last
  std::vector<Record> out;
  for (const std::span<const Record> cell : by_cell(records)) {
    const std::size_t before = out.size();
    for (const Record& r : cell) {
      if (r.has_score() && !is_kept(r)) continue;
      Record& kept = out.emplace_back(r);
      if (!has_numbers(r.status)) kept.pairs = kept.possible = 0;
    }
    if (out.size() == before) out.emplace_back().cell = cell.front().cell;
  }
  return out;
}

}  // namespace loopbench::harness
