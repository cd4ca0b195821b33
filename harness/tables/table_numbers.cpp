#include "harness/tables/table_numbers.hpp"

#include "harness/compare/observations.hpp"
#include "harness/model/recorded_run.hpp"

namespace loopbench::harness {
namespace {

std::vector<std::string> with(std::vector<std::string> fields, const char* more) {
  fields.emplace_back(more);
  return fields;
}

std::vector<std::string> column_fields(const TableSpec& spec) {
  std::vector<std::string> out = with(spec.columns, "unit");
  for (const char* name : {"metric", "relation"}) out.emplace_back(name);
  return out;
}

/// With the unit of the statistic; counts have none that would tell translation and rotation apart.
std::string column_name(const Record& r,
                        const std::vector<std::string>& names,
                        const std::string& statistic) {
  std::string out = fields_joined(r, names, " ");
  const std::string unit = unit_of(r, statistic);
  if (!unit.empty()) return out + " [" + unit + "]";
  const bool has_relation =
      std::ranges::count(names, "relation") > 0 || std::ranges::count(names, "score") == 0;
  if (statistic == "count" && !has_relation && r.relation == "rotation") out += " rotation";
  return out;
}

/// Records of different kinds must not be averaged: all labels but sequence, repeat and method.
std::string kind_of(const Record& r) {
  return r.times + " / " + metric_label(r) + " / " + r.relation + " / " + r.axis + " [" + r.unit +
         "]";
}

/// Runs of recorded files are independent; their sequence is the recording.
void add_recordings(MarkInput& out, const TableNumbers& table) {
  std::map<std::string_view, std::size_t> numbers;
  std::vector<std::size_t> of_group;
  for (const std::string& group : table.groups.texts()) {
    const std::string_view recording = recording_of(group);
    if (recording.empty()) return;
    of_group.push_back(numbers.emplace(recording, numbers.size()).first->second);
  }
  for (const std::size_t group : table.group_of_run) out.sequence.push_back(of_group[group]);
  out.is_paired = false;
}

}  // namespace

TableNumbers::TableNumbers(const TableSpec& spec)
    : rows(with(spec.rows, "oracle"),
           [names = spec.rows](const Record& r) {
             return fields_joined(r, names, ", ") + (r.oracle ? " (oracle)" : "");
           }),
      columns(column_fields(spec),
              [names = spec.columns, value = spec.value](const Record& r) {
                return column_name(r, names, value);
              }),
      kinds({"times", "label", "relation", "axis", "unit"}, kind_of),
      runs({"content", "sequence", "repeat"}, run_key),
      groups({"group", "sequence", "repeat"}, group_name) {}

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
  const std::size_t entries = (along_columns ? table.rows : table.columns).texts().size();
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

}  // namespace loopbench::harness
