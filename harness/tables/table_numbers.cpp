#include "harness/tables/table_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "harness/compare/observations.hpp"
#include "harness/model/recorded_run.hpp"
#include "metrics/numerics/average.hpp"

namespace loopbench::harness {
namespace {

/// Runs of recorded files are independent; their sequence is the recording.
void add_recordings(MarkInput& out, const TableNumbers& table) {
  std::map<std::string_view, std::size_t> numbers;
  std::vector<std::size_t> of_group;
  for (const std::string& group : table.groups.names()) {
    const std::string_view recording = recording_of(group);
    if (recording.empty()) return;
    of_group.push_back(numbers.emplace(recording, numbers.size()).first->second);
  }
  for (const std::size_t group : table.group_of_run) out.sequence.push_back(of_group[group]);
  out.is_paired = false;
}

}  // namespace

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

std::vector<TablePosition> entry_indices(const TableNumbers& table,
                                         std::size_t index,
                                         bool along_columns) {
  const std::size_t entries = (along_columns ? table.rows : table.columns).names().size();
  std::vector<TablePosition> out;
  for (std::size_t i = 0; i < entries; ++i) {
    out.push_back(along_columns ? TablePosition{i, index} : TablePosition{index, i});
  }
  return out;
}

MarkInput mark_input(const TableNumbers& table,
                     const std::vector<TablePosition>& positions,
                     bool along_columns) {
  MarkInput out{{}, table.group_of_run, metrics::Better::neither, 0.0};
  add_recordings(out, table);
  std::vector<bool> is_tried(table.group_of_run.size(), false);
  for (const TablePosition& position : positions) {
    ByRun& own = out.competitors.emplace_back();
    const EntryContents* entry = table.find(position);
    if (entry != nullptr) own = entry->numbers.runs();
    if (own.empty()) continue;
    out.better = entry->numbers.better();
    out.target = entry->numbers.target();
    for (const auto& [run, value] : own) is_tried[run] = true;
  }
  const auto lose = [&](ByRun& own, const RunSet& lost) {
    for (const std::size_t run : lost) {
      if (is_tried[run]) own.try_emplace(run);
    }
  };
  const auto lose_any = [&](ByRun& own, const auto& losses, const auto& key) {
    if (const auto found = losses.find(key); found != losses.end()) lose(own, found->second);
  };
  for (std::size_t i = 0; i < positions.size(); ++i) {
    ByRun& own = out.competitors[i];
    if (own.empty()) continue;
    const EntryContents& entry = *table.find(positions[i]);
    lose(own, entry.lost);
    if (along_columns) lose_any(own, table.lost_by_row, positions[i].first);
    if (!along_columns) lose_any(own, table.lost_by_method, entry.numbers.method());
  }
  return out;
}

std::size_t possible(const MarkInput& input, std::size_t i) {
  std::vector<bool> is_there(input.group.size(), false);
  for (const ByRun& other : input.competitors) {
    const bool shares = std::ranges::any_of(
        other, [&](const auto& one) { return input.competitors[i].contains(one.first); });
    if (!shares) continue;
    for (const auto& [run, value] : other) is_there[run] = true;
  }
  return static_cast<std::size_t>(std::ranges::count(is_there, true));
}

std::string run_key(const Record& r) { return r.content.empty() ? run_name(r) : r.content.text(); }

void EntryNumbers::add(const Record& record,
                       std::size_t run,
                       std::size_t group,
                       const std::string& statistic) {
  values_.push_back({run, group, record.method, value(record, statistic)});
  method_ = record.method;
  is_gain_ = record.metric == "gain" && statistic != "count";
  is_oracle_ = record.oracle;
  if (record.oracle) return;
  better_ = direction_of(record, statistic);
  target_ = record.target;
}

std::size_t EntryNumbers::averaged() const {
  return static_cast<std::size_t>(std::ranges::count(values_, true, &Value::is_kept));
}

RunSet EntryNumbers::finished() const {
  RunSet out;
  for (const Value& one : values_) {
    if (one.is_kept) out.insert(one.run);
  }
  return out;
}

ByRun EntryNumbers::runs() const {
  ByRun out;
  if (is_oracle_) return out;
  for (const Value& one : values_) out[one.run] = one.value;
  return out;
}

void EntryNumbers::keep(const RunSet& runs) {
  for (Value& one : values_) one.is_kept = one.is_kept && runs.contains(one.run);
}

std::vector<double> EntryNumbers::kept() const {
  std::vector<double> out;
  out.reserve(values_.size());
  for (const Value& one : values_) {
    if (one.is_kept) out.push_back(one.value);
  }
  return out;
}

double EntryNumbers::gain() const {
  std::map<std::size_t, std::map<std::pair<SharedText, std::size_t>, double>> by_group;
  for (const Value& one : values_) {
    if (one.is_kept) by_group[one.group][{one.method, one.run}] = one.value;
  }
  std::vector<double> groups;
  for (const auto& [group, gains] : by_group) {
    std::vector<double> logarithms;
    for (const auto& [run, gain] : gains) logarithms.push_back(std::log(1.0 - 0.01 * gain));
    groups.push_back(metrics::mean(logarithms));
  }
  return 100.0 * (1.0 - std::exp(metrics::mean(groups)));
}

std::optional<double> EntryNumbers::average() const {
  const std::vector<double> all = kept();
  // One zero error would make the geometric mean zero.
  const auto zeros = std::ranges::count(all, 100.0);
  const bool has_no_mean = is_gain_ && zeros > 0 && zeros < std::ssize(all);
  if (all.empty() || has_no_mean) return std::nullopt;
  const double out = is_gain_ ? gain() : metrics::mean(all);
  return std::isfinite(out) ? std::optional(out) : std::nullopt;
}

std::optional<double> EntryNumbers::deviation() const {
  const std::vector<double> all = kept();
  if (all.size() < 2) return std::nullopt;
  const double out = metrics::sample_deviation(all);
  return std::isfinite(out) ? std::optional(out) : std::nullopt;
}

}  // namespace loopbench::harness
