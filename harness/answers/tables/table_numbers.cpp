#include "harness/answers/tables/table_numbers.hpp"

#include <cmath>

#include "metrics/numerics/average.hpp"

namespace loopbench::harness {
namespace {

/// The gain or change of the geometric mean ratio. Of several values of a method on a run the last
/// one counts.
double mean_change(const TableEntry& entry) {
  std::map<std::size_t, std::map<std::pair<SharedText, std::size_t>, double>> by_group;
  for (const TableEntry::Value& one : entry.values) {
    if (one.is_kept) by_group[one.group][{one.method, one.run}] = one.value;
  }
  std::vector<double> groups;
  for (const auto& [group, changes] : by_group) {
    std::vector<double> logarithms;
    for (const auto& [run, change] : changes)
      logarithms.push_back(std::log(1.0 + 0.01 * entry.ratio_sign * change));
    groups.push_back(metrics::mean(logarithms));
  }
  const double ratio = std::exp(metrics::mean(groups));
  return 100.0 * (entry.ratio_sign < 0 ? 1.0 - ratio : ratio - 1.0);  // not -0 for a ratio of 1
}

std::map<SharedText, std::vector<double>> kept_by_sequence(const TableEntry& entry) {
  std::map<SharedText, std::vector<double>> out;
  for (const TableEntry::Value& one : entry.values) {
    if (one.is_kept) out[one.sequence].push_back(one.value);
  }
  return out;
}

double mean_of_sequences(const TableEntry& entry) {
  std::vector<double> means;
  for (const auto& [sequence, own] : kept_by_sequence(entry)) means.push_back(metrics::mean(own));
  return metrics::mean(means);
}

/// Removes the runs that are not in `others`.
void keep_only(RunSet& runs, const RunSet& others) {
  std::erase_if(runs, [&](std::size_t run) { return !others.contains(run); });
}

bool intersect(const RunSet& a, const RunSet& b) {
  return std::ranges::any_of(a, [&](std::size_t run) { return b.contains(run); });
}

/// The runs of one entry with values.
struct EntryRuns {
  TableEntry* entry = nullptr;
  RunSet tried;     ///< runs with any outcome
  RunSet finished;  ///< runs with a number; subset of `tried`
  RunSet known;     ///< finished, or failed where another entry has finished; empty for an oracle
};

struct LaneRuns {
  std::vector<EntryRuns> entries;
  RunSet finished;  ///< of any entry but those of oracles
};

/// Runs that the entries of a column (or a row) tried and finished.
LaneRuns lane_runs(TableNumbers& table, std::size_t lane, bool along_columns) {
  LaneRuns out;
  const std::size_t entries = (along_columns ? table.rows : table.columns).names().size();
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t row = along_columns ? i : lane;
    TableEntry& entry = table.entries[row][along_columns ? lane : i];
    if (entry.values.empty()) continue;
    EntryRuns& own = out.entries.emplace_back(EntryRuns{&entry, entry.tried, {}, entry.lost});
    for (const TableEntry::Value& one : entry.values) {
      if (one.is_kept) own.finished.insert(one.run);
    }
    const auto add = [&](const auto& losses, const auto& key) {
      const auto lost = losses.find(key);
      if (lost == losses.end()) return;
      own.tried.insert(lost->second.begin(), lost->second.end());
      own.known.insert(lost->second.begin(), lost->second.end());
    };
    if (along_columns) add(table.lost_by_row, row);
    if (!along_columns) add(table.lost_by_method, entry.values.back().method);
    if (entry.is_oracle) {
      own.known.clear();
      continue;
    }
    out.finished.insert(own.finished.begin(), own.finished.end());
    own.known.insert(own.finished.begin(), own.finished.end());
  }
  for (EntryRuns& own : out.entries) keep_only(own.known, out.finished);
  return out;
}

/// Returns for each entry the runs that all entries compared with it have finished. Two entries are
/// compared if both finished at least one run and tried a common run, directly or through other
/// entries. A method that fails everywhere and entries of other sequences therefore do not restrict
/// the runs. O(entries^2 * runs).
std::vector<RunSet> common_runs(const std::vector<EntryRuns>& entries) {
  std::vector<RunSet> out(entries.size());
  std::vector<bool> is_done(entries.size());
  for (std::size_t first = 0; first < entries.size(); ++first) {
    if (is_done[first] || entries[first].finished.empty()) continue;
    std::vector<std::size_t> compared{first};
    is_done[first] = true;
    RunSet common = entries[first].finished;
    for (std::size_t i = 0; i < compared.size(); ++i) {
      for (std::size_t other = 0; other < entries.size(); ++other) {
        if (is_done[other] || entries[other].finished.empty()) continue;
        if (!intersect(entries[compared[i]].tried, entries[other].tried)) continue;
        compared.push_back(other);
        is_done[other] = true;
        keep_only(common, entries[other].finished);
      }
    }
    for (const std::size_t i : compared) out[i] = common;
  }
  return out;
}

/// Number of runs that entry `i` lacks of those of all entries that have a known run in common with
/// it.
std::size_t count_missing(const LaneRuns& lane, std::size_t i) {
  const EntryRuns& own = lane.entries[i];
  if (own.finished.size() == lane.finished.size()) return 0;
  RunSet all;
  for (const EntryRuns& other : lane.entries) {
    if (intersect(other.known, own.known)) all.insert(other.known.begin(), other.known.end());
  }
  return all.empty() ? 0 : all.size() - own.finished.size();
}

std::string runs_text(const std::set<std::size_t>& runs) {
  std::string out;
  for (const std::size_t count : runs) {
    out += (out.empty() ? "" : " or ") + (count == 0 ? "none (-)" : std::to_string(count));
  }
  return out;
}

/// "means over the 4 runs that every method finished", for the numbers of runs of the means in each
/// column (or row); empty without any.
std::string common_runs_note(const std::map<std::string, std::set<std::size_t>>& counts) {
  if (counts.empty()) return "";
  const std::set<std::size_t>& first = counts.begin()->second;
  const bool is_one = std::ranges::all_of(
      counts, [&](const auto& entry) { return first.size() == 1 && entry.second == first; });
  if (is_one && first.contains(0)) return "no means (-): no run was finished by every method";
  if (is_one) {
    return "means over the " + std::to_string(*first.begin()) +
           (first.contains(1) ? " run" : " runs") + " that every method finished";
  }
  std::string out;
  for (const auto& [name, runs] : counts) {
    out += (out.empty() ? "" : ", ") + name + ": " + runs_text(runs);
  }
  return "means over the runs that every method finished (" + out + ")";
}

}  // namespace

std::vector<double> TableEntry::kept() const {
  std::vector<double> out;
  out.reserve(values.size());
  for (const Value& one : values) {
    if (one.is_kept) out.push_back(one.value);
  }
  return out;
}

bool TableEntry::is_uneven() const {
  const auto all = kept_by_sequence(*this);
  return std::ranges::any_of(
      all, [&](const auto& each) { return each.second.size() != all.begin()->second.size(); });
}

std::optional<double> TableEntry::average() const {
  const std::vector<double> all = kept();
  // One zero error would make the geometric mean zero.
  const auto zeros = std::ranges::count(all, -100.0 * ratio_sign);
  const bool has_no_mean = is_ratio() && zeros > 0 && zeros < std::ssize(all);
  if (all.empty() || has_no_mean) return std::nullopt;
  double out = is_ratio() ? mean_change(*this) : metrics::mean(all);
  if (!is_ratio() && is_uneven()) out = mean_of_sequences(*this);
  return std::isfinite(out) ? std::optional(out) : std::nullopt;
}

std::vector<double> TableEntry::weights() const {
  std::map<SharedText, double> counts;
  for (const Value& one : values) counts[one.sequence] += one.is_kept ? 1.0 : 0.0;
  const auto sequences = static_cast<double>(
      std::ranges::count_if(counts, [](const auto& each) { return each.second > 0.0; }));
  const double equal = 1.0 / static_cast<double>(kept().size());
  const bool is_by_sequence = !is_ratio() && is_uneven();
  std::vector<double> out;
  for (const Value& one : values) {
    if (!one.is_kept) continue;
    out.push_back(is_by_sequence ? 1.0 / (sequences * counts[one.sequence]) : equal);
  }
  return out;
}

double TableEntry::effective() const {
  double squares = 0.0;
  for (const double weight : weights()) squares += weight * weight;
  return squares > 0.0 ? 1.0 / squares : 0.0;
}

std::optional<double> TableEntry::deviation() const {
  const std::vector<double> all = kept(), of = weights();
  if (all.size() < 2) return std::nullopt;
  double mean = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < all.size(); ++k) mean += of[k] * all[k];
  for (std::size_t k = 0; k < all.size(); ++k) {
    squares += of[k] * (all[k] - mean) * (all[k] - mean);
  }
  const double out = std::sqrt(squares / (1.0 - 1.0 / effective()));
  return std::isfinite(out) ? std::optional(out) : std::nullopt;
}

std::string fields_joined(const Record& record,
                          const std::vector<std::string>& names,
                          const char* glue) {
  std::string out;
  for (const std::string& name : names) {
    const std::string text = field(record, name);
    if (!text.empty()) out += (out.empty() ? "" : glue) + text;
  }
  return out;
}

std::string keep_common_runs(TableNumbers& table, bool along_columns) {
  const std::vector<std::string>& names = (along_columns ? table.columns : table.rows).names();
  std::map<std::string, std::set<std::size_t>> counts;
  for (std::size_t l = 0; l < names.size(); ++l) {
    const LaneRuns lane = lane_runs(table, l, along_columns);
    const std::vector<RunSet> common = common_runs(lane.entries);
    for (std::size_t i = 0; i < lane.entries.size(); ++i) {
      const EntryRuns& own = lane.entries[i];
      if (own.finished.empty()) continue;
      own.entry->missing = count_missing(lane, i);
      if (own.finished == common[i]) continue;
      counts[names[l]].insert(common[i].size());
      for (TableEntry::Value& one : own.entry->values) {
        one.is_kept = one.is_kept && common[i].contains(one.run);
      }
    }
  }
  return common_runs_note(counts);
}

}  // namespace loopbench::harness
