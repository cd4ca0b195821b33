/// Reviewed numbers of a sweep: the reference of `loopbench check`.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "datasets/core/error.hpp"
#include "harness/sweep/model/record.hpp"
#include "harness/sweep/model/where.hpp"

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
  using Definitions = std::map<std::string, std::string>;  ///< by label

  std::string sweep;
  std::string machine;    ///< compiler, C library and CPU of all cells
  Definitions sequences;  ///< all options, hashes of files
  Definitions contents;   ///< hashes of problem and reference
  Definitions protocols;  ///< every rule, by label and version
  Definitions metrics;    ///< name, all options
  Definitions methods;    ///< stages, all options
  /// Neighbours belong to one cell. A cell without checked scores has one record without a score.
  std::vector<Record> records;
};

/// The definitions of a snapshot, in the order of the file.
struct DefinitionKind {
  const char* name;
  Snapshot::Definitions Snapshot::*member;
  const char* one;  ///< in messages
};
inline constexpr DefinitionKind kDefinitions[] = {{"sequences", &Snapshot::sequences, "sequence"},
                                                  {"contents", &Snapshot::contents, ""},
                                                  {"protocols", &Snapshot::protocols, "protocol"},
                                                  {"metrics", &Snapshot::metrics, "metric"},
                                                  {"methods", &Snapshot::methods, "method"}};

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

/// Metrics of measured times and memory, which differ between runs of one build.
inline constexpr std::array kMeasuredTimes{"time", "cpu_ms", "wall_ms", "memory_mb", "update_time"};

inline bool is_measured_time(const Record& score) {
  return std::ranges::count(kMeasuredTimes, score.kind->metric) > 0;
}

/// Limits for times, compared between runs on the same CPU: a cell's median processor time [ms],
/// which other processes hardly change, and the times of its updates [s] (neither their growth nor
/// missed deadlines).
inline std::vector<Tolerance> time_limits(double relative) {
  const Tolerance of_cells{
      .where = {"metric=cpu_ms"}, .values = {"rmse"}, .relative = relative, .absolute = 1.0};
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

/// Whether some of its cells were computed by a build with uncommitted changes.
inline bool is_dirty(const std::map<std::string, std::string>& build_summary) {
  const auto source = build_summary.find("source");
  std::istringstream builds(source == build_summary.end() ? "" : source->second);
  for (std::string state; std::getline(builds, state);) {  // one of each build: clean | dirty
    if (state == "dirty") return true;
  }
  return false;
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

/// A function that returns the first of the limits whose `where` selects a score, or null. It keeps
/// references to `limits`.
inline std::function<const Tolerance*(const Record&)> limit_of(
    const std::vector<Tolerance>& limits) {
  std::vector<std::function<bool(const Record&)>> filters;
  for (const Tolerance& limit : limits) filters.push_back(where(limit.where));
  return [filters, &limits](const Record& score) {
    const auto selects = [&](const auto& keeps) { return keeps(score); };
    const auto found = std::ranges::find_if(filters, selects) - filters.begin();
    return found == std::ssize(filters) ? nullptr : &limits[static_cast<std::size_t>(found)];
  };
}

/// The checked ones of a store's records, for a snapshot: every score except a measured time
/// without a limit about times. O(n log n).
inline std::vector<Record> checked_records(std::vector<Record> records,
                                           const std::vector<Tolerance>& limits) {
  std::vector<Tolerance> of_times = limits;
  std::erase_if(of_times, [](const Tolerance& limit) { return !limits_time(limit); });
  const auto time_limit = limit_of(of_times);
  const auto position = [](const Record& r) { return r.cell->position; };
  std::ranges::stable_sort(records, {}, position);  // derived ones are last
  std::vector<Record> out;
  for (const std::span<const Record> cell : by_cell(records)) {
    const std::size_t before = out.size();
    for (const Record& r : cell) {
      if (r.has_score() && is_measured_time(r) && time_limit(r) == nullptr) continue;
      Record& kept = out.emplace_back(r);
      if (!has_numbers(r.status)) kept.pairs = kept.possible = 0;
    }
    if (out.size() == before) out.emplace_back().cell = cell.front().cell;
  }
  return out;
}

inline bool selects_a_score(const Tolerance& limit, const Snapshot& snapshot) {
  const auto keeps = where(limit.where);
  return std::ranges::any_of(snapshot.records,
                             [&](const Record& r) { return r.has_score() && keeps(r); });
}

inline std::string numbers_of(const Tolerance& limit) {
  return fmt::format("{}: relative {:g}, absolute {:g}",
                     fmt::join(limit.values, ", "),
                     limit.relative,
                     limit.absolute);
}

/// Throws InputError if the baseline has no limits, or a limit that selects none of its scores:
/// such a limit is misspelt and would let every change pass. A baseline without any score is only
/// about statuses.
inline void require_used_limits(const Baseline& baseline) {
  if (baseline.limits.empty()) {
    throw InputError("limits: is empty, so that every change would pass; expected at least one");
  }
  if (std::ranges::none_of(baseline.snapshot.records, &Record::has_score)) return;
  for (std::size_t i = 0; i < baseline.limits.size(); ++i) {
    const Tolerance& limit = baseline.limits[i];
    if (selects_a_score(limit, baseline.snapshot)) continue;
    throw InputError(fmt::format("limits[{}].where: '{}' selects no score of the baseline",
                                 i,
                                 fmt::join(limit.where, ", ")));
  }
}

/// A line for every limit that is not the default, because a wide limit lets changes pass.
inline std::vector<std::string> notes_on_limits(const std::vector<Tolerance>& limits) {
  const std::string standard = numbers_of({});
  std::vector<std::string> out;
  for (const Tolerance& limit : limits) {
    const std::string own = numbers_of(limit);
    if (own == standard) continue;
    out.push_back(fmt::format(
        "limit of {}: {} (default: {})",
        limit.where.empty() ? "all scores" : fmt::format("{}", fmt::join(limit.where, ", ")),
        own,
        standard));
  }
  return out;
}

/// Incremented when the contents of a baseline change.
inline constexpr int kBaselineFormat = 5;

/// JSON with one line per cell: definitions of sequences, protocols, metrics and methods, limits,
/// the list of scores, then for every cell the pose pairs, counts and statistics in that order;
/// null if a score is missing or has no number. `statuses` only if some score is not ok; `possible`
/// and `counts` only if they differ from `pairs`; all of these as [[value, repetitions], ...].
/// Statistics have the digits that the limits can see: their errors are up to a thousandth of the
/// smallest limit (`precision`).
std::string json(const Baseline& baseline);

/// Hash of all that a baseline's JSON contains, except its limits, which users edit, and `digest`,
/// which is this hash. Throws nlohmann::json::exception if it is not a JSON object.
std::string digest_of(const std::string& text);

/// Throws InputError for a file that was changed since it was written (see digest_of), for limits
/// less than ten times its precision, and
/// `file:line:` for invalid JSON, `file: cells[3].rmse:` for an invalid baseline.
Baseline parse_baseline(const std::string& text, const std::string& file);
Baseline read_baseline(const std::filesystem::path& file);

/// Only the limits, for any format of the rest of the file.
std::vector<Tolerance> read_limits(const std::filesystem::path& file);

}  // namespace loopbench::harness
