#include "harness/answers/tables/pivot.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "datasets/core/error.hpp"
#include "harness/answers/compare/observations.hpp"
#include "harness/answers/compare/stated.hpp"
#include "harness/answers/tables/error_counts.hpp"
#include "harness/answers/tables/table_numbers.hpp"

namespace loopbench::harness {
namespace {

/// With the unit of the statistic; counts have none that would tell translation and rotation apart.
std::string column_name(const Record& r,
                        const std::vector<std::string>& names,
                        const std::string& statistic,
                        const std::string& unit) {
  std::string out = fields_joined(r, names, " ");
  if (!unit.empty()) return out + unit_suffix(unit);
  const bool has_relation =
      std::ranges::count(names, "relation") > 0 || std::ranges::count(names, "score") == 0;
  if (statistic == "count" && !has_relation && r.kind->relation == "rotation") out += " rotation";
  return out;
}

/// Records of different kinds must not be averaged: all labels but sequence, repeat and method.
std::string kind_text(const ScoreKind& kind) {
  return kind.times + " / " + kind.metric_label() + " / " + kind.relation + " / " + kind.axis +
         " [" + kind.unit + "]";
}

/// Key of a run: the content of its data if known, otherwise which run it is.
std::string run_key(const CellRow& cell) {
  return cell.content.empty() ? run_id(cell) : cell.content.text();
}

/// The entry at the position, made if it is new.
TableEntry& entry_at(TableNumbers& table, std::size_t row, std::size_t column) {
  if (table.entries.size() <= row) table.entries.resize(row + 1);
  std::vector<TableEntry>& entries = table.entries[row];
  if (entries.size() <= column) entries.resize(column + 1);
  return entries[column];
}

void add(TableNumbers& table, const Record& record, const TableSpec& spec) {
  const std::size_t row = table.rows.index(fields_joined(record, spec.rows, ", ") +
                                           (record.cell->oracle ? " (oracle)" : ""));
  if (record.cell->oracle) table.note("oracle: the method uses the reference");
  if (record.cell->oracle_closures) table.oracle_sequences.insert(record.cell->sequence);
  const std::size_t run = table.runs.index(run_key(*record.cell));
  if (run == table.group_of_run.size())
    table.group_of_run.push_back(table.groups.index(group_id(*record.cell)));
  table.records.push_back({&record, row});
  const bool is_ok = record.status == Status::ok;
  if (!is_ok) {
    // Low coverage concerns all metrics; an undefined score is listed by its name.
    const bool is_complete_cell = !record.has_score() || record.status == Status::incomplete;
    const std::string what =
        is_complete_cell ? "" : fields_joined(record, {"label", "relation"}, " ");
    table.missing.push_back({table.rows.names()[row], what, to_text(record.status), record.why});
  } else if (!record.has_score() && !record.why.empty()) {
    table.note(table.rows.names()[row] + ": " + record.why.text());
  }
  if (!record.has_score()) {
    if (is_ok) return;
    table.row_status[row] = to_text(record.status);
    table.lost_by_row[row].insert(run);
    table.lost_by_method[record.cell->method].insert(run);
    return;
  }
  const std::string unit = unit_of(*record.kind, spec.value);
  const std::size_t column =
      table.columns.index(column_name(record, spec.columns, spec.value, unit));
  if (column == table.units.size()) table.units.push_back(unit);
  table.records.back().column = column;
  TableEntry& entry = entry_at(table, row, column);
  if (entry.tried.empty()) entry.kind = record.kind;
  if (entry.kind != record.kind && kind_text(*entry.kind) != kind_text(*record.kind)) {
    throw InputError("an entry of this table would average '" + kind_text(*entry.kind) +
                     "' with '" + kind_text(*record.kind) +
                     "'; add the column in which they differ");
  }
  // The first value stands for all: a second method is refused here.
  if (!entry.values.empty() && entry.values.front().method != record.cell->method &&
      is_by_option(spec)) {
    throw InputError("an entry of this table would average '" + entry.values.front().method +
                     "' with '" + record.cell->method + "'; choose methods with --where");
  }
  entry.tried.insert(run);
  if (!is_ok) {
    entry.status = to_text(record.status);
    if (is_loss(record)) entry.lost.insert(run);
    return;
  }
  if (is_stated(record)) {
    entry.is_stated = true;
    table.note({kStatedNote, kStatedInPaper});
  }
  entry.is_gap = record.kind->metric == "optimality" && record.kind->relation == "gap" &&
                 spec.value != "count";
  add_error_count(table, column, record);
  entry.ratio_sign = spec.value == "count" ? 0 : sign_of_ratio(record.kind->metric);
  entry.is_oracle = record.cell->oracle;
  entry.values.push_back({run,
                          table.group_of_run[run],
                          record.cell->method,
                          record.cell->sequence,
                          value(record, spec.value)});
}

/// Adds a note on how the numbers were averaged, and facts for a caption.
void explain_averages(Table& out, const TableNumbers& table, const TableSpec& spec) {
  std::size_t most = 1;
  bool is_uneven = false;
  std::set<int> ratio_signs;
  for (const std::vector<TableEntry>& row : table.entries) {
    for (const TableEntry& entry : row) {
      most = std::max(most, entry.kept().size());
      ratio_signs.insert(entry.ratio_sign);
      is_uneven = is_uneven || (!entry.is_ratio() && entry.is_uneven());
    }
  }
  std::set<std::string> times;
  for (const PlacedRecord& each : table.records) {
    if (each.column) times.insert(each.record->kind->times);
  }
  times.erase("");
  out.facts = fmt::format("{}; times: {}", spec.value, fmt::join(times, ", "));
  if (most < 2) return;
  out.facts += fmt::format("; runs per number: at most {}", most);
  out.averages = {.most = most,
                  .is_uneven = is_uneven,
                  .deviation = spec.plus_minus ? Deviation::standard : Deviation::none,
                  .has_gain = ratio_signs.contains(-1),
                  .has_change = ratio_signs.contains(1)};
  out.notes.insert(out.notes.begin(), averages_text(*out.averages));
}

/// The mean of an entry, or the reason why it has none.
TableCell mean_at(const TableNumbers& table, std::size_t row, std::size_t column, bool plus_minus) {
  TableCell out;
  out.has_mean = true;
  if (const auto lost = table.row_status.find(row); lost != table.row_status.end()) {
    out.status = lost->second;
  }
  const TableEntry& entry = table.entries[row][column];
  if (!entry.status.empty()) out.status = entry.status;
  if (entry.values.empty()) return out;
  out.value = entry.average();
  if (plus_minus) out.deviation = entry.deviation();
  out.is_stated = entry.is_stated;
  out.is_gap = entry.is_gap;
  out.records = entry.values.size();
  out.averaged = entry.kept().size();
  out.effective = entry.effective();
  if (entry.missing > 0) out.possible = out.records + entry.missing;
  if (!out.value) out.status = out.averaged == 0 ? kNoCommonRun : "undefined";
  return out;
}

Table finish(TableNumbers& table, const std::string& title, const TableSpec& spec) {
  // Only methods are compared: a best sequence is meaningless.
  const bool down_columns = std::ranges::count(spec.rows, "method") > 0;
  const bool along_rows = spec.columns == std::vector<std::string>{"method"};
  const std::vector<std::string>& columns = table.columns.names();
  Table out{title, {fmt::format("{}", fmt::join(spec.rows, ", "))}, {}, table.notes};
  out.headings.insert(out.headings.end(), columns.begin(), columns.end());
  out.units = table.units;
  out.units.insert(out.units.begin(), "");
  const std::vector<std::string> missing = grouped(table.missing);
  out.notes.insert(out.notes.end(), missing.begin(), missing.end());
  if (const std::string counts = error_counts_text(table); !counts.empty()) {
    out.notes.push_back("number of errors, where it differs from the evaluated pairs: " + counts);
  }
  const std::string oracle =
      oracle_closures_note(table.oracle_sequences, table.oracle_sequences.size());
  if (!oracle.empty()) out.notes.push_back(oracle);
  table.entries.resize(table.rows.names().size());
  for (std::vector<TableEntry>& row : table.entries) row.resize(columns.size());
  for (const bool along_columns : {true, false}) {
    if (!(along_columns ? down_columns : along_rows)) continue;
    const std::string text = keep_common_runs(table, along_columns);
    if (!text.empty()) out.notes.insert(out.notes.begin(), text);
  }
  explain_averages(out, table, spec);
  std::ranges::sort(table.records, {}, &PlacedRecord::record);  // as given
  for (std::size_t r = 0; r < table.rows.names().size(); ++r) {
    std::vector<TableCell>& line = out.lines.emplace_back();
    line.emplace_back(table.rows.names()[r]);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      line.push_back(mean_at(table, r, c, spec.plus_minus));
    }
  }
  if (down_columns) mark_best(out, table, spec, true);
  if (along_rows) mark_best(out, table, spec, false);
  format_means(out);
  return out;
}

/// Splits the tables by protocol if there are several, unless the spec already separates them.
TableSpec separating_protocols(TableSpec spec, const std::vector<Record>& records) {
  if (separates(spec, {"protocol"})) return spec;
  const std::string* first = nullptr;
  for (const Record& record : records) {
    if (!record.has_score()) continue;
    if (first == nullptr) first = &record.kind->protocol;
    if (record.kind->protocol == *first) continue;
    spec.split.emplace_back("protocol");
    break;
  }
  return spec;
}

}  // namespace

std::vector<Table> pivot(const std::vector<Record>& records, const TableSpec& spec) {
  std::vector<Table> out = pivot_parts(records, separating_protocols(spec, records));
  if (out.empty()) throw InputError(kEmptyTable);
  return out;
}

std::vector<Table> pivot_parts(const std::vector<Record>& records, const TableSpec& spec) {
  NameOrder titles;
  std::vector<TableNumbers> builders;
  std::vector<const Record*> first;  // of each table
  const auto builder = [&](const Record& record) -> TableNumbers& {
    const std::size_t index = titles.index(fields_joined(record, spec.split, ", "));
    if (index == builders.size()) {
      builders.emplace_back();
      first.push_back(&record);
    }
    return builders[index];
  };
  // A cell without any score has no times and no protocol.
  const auto belongs_to = [&](const Record& record, std::size_t table) {
    return std::ranges::all_of(spec.split, [&](const std::string& name) {
      const std::string own = field(record, name);
      return own.empty() || own == field(*first[table], name);
    });
  };
  const auto shown = [&](const Record& record) {
    return spec.show.empty() || std::ranges::count(spec.show, record.kind->short_name()) > 0;
  };
  for (const Record& record : records) {
    if (record.has_score() && shown(record)) add(builder(record), record, spec);
  }
  const std::size_t with_scores = builders.size();
  // A cell without any score is listed in every table of its sequence.
  for (const Record& record : records) {
    if (record.has_score()) continue;
    bool placed = false;
    for (std::size_t t = 0; t < with_scores; ++t) {
      if (!belongs_to(record, t)) continue;
      add(builders[t], record, spec);
      placed = true;
    }
    if (!placed) add(builder(record), record, spec);
  }
  std::vector<Table> out;
  for (std::size_t t = 0; t < builders.size(); ++t) {
    out.push_back(finish(builders[t], titles.names()[t], spec));
    out.back().has_scores = t < with_scores;
  }
  return out;
}

bool is_by_option(const TableSpec& spec) {
  const auto is_option = [](const std::string& name) { return !has_field(Record(), name); };
  return !separates(spec, {"method"}) && (std::ranges::any_of(spec.rows, is_option) ||
                                          std::ranges::any_of(spec.columns, is_option));
}

bool separates(const TableSpec& spec, std::initializer_list<const char*> any_of) {
  for (const auto* names : {&spec.rows, &spec.columns, &spec.split}) {
    for (const char* name : any_of) {
      if (std::ranges::count(*names, name) > 0) return true;
    }
  }
  return false;
}

}  // namespace loopbench::harness
