/// Reviewed numbers of a sweep: the reference of `loopbench check`.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "harness/compare/observations.hpp"
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

/// One score of one cell with the statistics that have a limit.
struct GateScore : Record {
  std::int64_t count = 0;                ///< errors behind the statistics, for example RPE pairs
  std::map<std::string, double> values;  ///< by statistic; empty if the status has no number
};

/// The record of a cell without its scores, and these.
struct GateCell : Record {
  std::vector<GateScore> scores;
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
  std::vector<GateCell> cells;
};

struct Baseline {
  std::map<std::string, std::string>
      build_summary;                           ///< version, compiler, commit, source clean or dirty
  std::vector<Tolerance> limits{Tolerance{}};  ///< the first whose `where` matches a score applies
  Snapshot snapshot;
};

inline GateScore gate_score(const Record& r, const std::set<std::string>& statistics) {
  GateScore out{r, 0, {}};
  if (has_numbers(r.status)) {
    out.count = static_cast<std::int64_t>(r.statistics.count);
    for (const std::string& statistic : statistics) out.values[statistic] = value(r, statistic);
  } else {
    out.pairs = out.possible = 0;
  }
  return out;
}

/// Metrics of measured times, which differ between runs of one build.
inline constexpr std::array kMeasuredTimes{"time", "update_time"};

inline bool is_measured_time(const Record& score) {
  return std::ranges::count(kMeasuredTimes, score.metric.text()) > 0;
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

/// "room (repeat 2) / uniform".
inline std::string name(const GateCell& cell) { return run_name(cell) + " / " + cell.method; }

/// "ate translation 3d, dense, loopbench".
inline std::string name(const GateScore& score) {
  std::string out = metric_label(score);
  for (const std::string& word : {score.relation.text(), score.axis.text()}) {
    if (!word.empty()) out += " " + word;
  }
  return out + ", " + score.times + ", " + score.protocol;
}

/// The cells of a store's records (without derived ones) with their checked scores and the
/// statistics in `limits`. Throws InputError for an unknown statistic. O(n log n).
inline std::vector<GateCell> gate_cells(const std::vector<Record>& records,
                                        const std::vector<Tolerance>& limits) {
  std::set<std::string> statistics;
  for (const Tolerance& limit : limits) {
    for (const std::string& statistic : limit.values) {
      value(Record{}, statistic);  // rejects an unknown statistic even without records
      statistics.insert(statistic);
    }
  }
  const auto is_kept = is_checked(limits);
  std::vector<GateCell> out;
  std::map<std::int64_t, std::size_t> positions;
  for (const Record& r : records) {
    const auto [found, is_new] = positions.emplace(r.cell, out.size());
    if (is_new) {
      out.push_back({r, {}});
      if (!r.metric.empty()) out.back().status = Status::ok;  // a cell with scores has no failure
    }
    if (r.metric.empty() || !is_kept(r)) continue;
    out[found->second].scores.push_back(gate_score(r, statistics));
  }
  return out;
}

}  // namespace loopbench::harness
