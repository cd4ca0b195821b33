#include "harness/tables/pivot.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "datasets/core/error.hpp"
#include "harness/compare/name_order.hpp"
#include "harness/compare/observations.hpp"
#include "harness/tables/cell_numbers.hpp"
#include "harness/tables/error_counts.hpp"
#include "harness/tables/notes.hpp"

namespace loopbench {
namespace {

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

/// What must not be averaged with another: everything but sequence, repeat and method.
std::string kind(const Record& r) {
  return r.times + " / " + metric_label(r) + " / " + r.relation + " / " + r.axis + " [" + r.unit +
         "]";
}

using Place = std::pair<std::size_t, std::size_t>;  // row, column

struct Builder {
  NameOrder rows;
  NameOrder columns;
  std::map<Place, CellNumbers> numbers;
  std::map<Place, std::string> status;  // of cells with a record that has no value
  std::map<Place, std::string> kinds;
  std::map<Place, std::set<std::string>> lost;               // runs on which a score failed
  std::map<std::size_t, std::set<std::string>> lost_by_row;  // runs that failed as a whole
  std::map<std::string, std::set<std::string>> lost_by_method;
  std::map<std::string, std::string> groups;  // of runs
  ErrorCounts counts;
  std::map<std::size_t, std::string> row_status;  // declined or failed as a whole
  std::set<std::string> oracle_sequences;         // whose closures are measured in the reference
  std::vector<Missing> missing;
  std::vector<std::string> notes;

  void note(const std::string& text) {
    if (std::ranges::count(notes, text) == 0) notes.push_back(text);
  }
};

void add(Builder& table, const Record& record, const TableSpec& spec) {
  std::string name = fields_joined(record, spec.rows, ", ");
  if (record.oracle) {
    name += " (oracle)";
    table.note("oracle: the method was shown the reference");
  }
  const std::size_t row = table.rows.index(name);
  if (record.oracle_closures) table.oracle_sequences.insert(record.sequence);
  table.groups[run_key(record)] = group_name(record);
  if (record.status != "ok") {
    // Too little coverage is one reason for every metric; an undefined number names itself.
    const bool is_whole = record.metric.empty() || record.status == "incomplete";
    const std::string what = is_whole ? "" : fields_joined(record, {"label", "relation"}, " ");
    table.missing.push_back({name, what, record.status, record.why});
  } else if (record.metric.empty() && !record.why.empty()) {
    table.note(name + ": " + record.why);
  }
  if (record.metric.empty()) {
    if (record.status == "ok") return;
    table.row_status[row] = record.status;
    table.lost_by_row[row].insert(run_key(record));
    table.lost_by_method[record.method].insert(run_key(record));
    return;
  }
  const std::string unit = record.unit.empty() ? "" : " [" + record.unit + "]";
  const std::size_t column = table.columns.index(fields_joined(record, spec.columns, " ") + unit);
  const std::string own = kind(record);
  if (const std::string& other = table.kinds.emplace(std::pair{row, column}, own).first->second;
      other != own) {
    throw InputError("a cell of this table would average '" + other + "' with '" + own +
                     "'; add the column that tells them apart");
  }
  if (record.status != "ok") {
    table.status[{row, column}] = record.status;
    if (is_loss(record)) table.lost[{row, column}].insert(run_key(record));
    return;
  }
  table.counts.add(column, record);
  table.numbers[{row, column}].add(record, value(record, spec.value));
}

/// The cells of a column (or a row) that compete, with the runs on which they failed.
Lane lane(const Builder& table, const std::vector<Place>& places, bool along_columns) {
  Lane out{{}, table.groups, Better::neither, 0.0};
  std::set<std::string> runs;
  for (const Place& place : places) {
    ByRun& own = out.competitors.emplace_back();
    const auto found = table.numbers.find(place);
    if (found == table.numbers.end() || found->second.runs().empty()) continue;
    own = found->second.runs();
    out.better = found->second.better();
    out.target = found->second.target();
    for (const auto& [run, value] : own) runs.insert(run);
  }
  const auto lose = [&](ByRun& own, const auto& losses, const auto& key) {
    const auto found = losses.find(key);
    if (own.empty() || found == losses.end()) return;
    for (const std::string& run : found->second) {
      if (runs.contains(run)) own.emplace(run, std::nullopt);
    }
  };
  for (std::size_t i = 0; i < places.size(); ++i) {
    ByRun& own = out.competitors[i];
    if (own.empty()) continue;
    lose(own, table.lost, places[i]);
    if (along_columns) lose(own, table.lost_by_row, places[i].first);
    if (!along_columns) lose(own, table.lost_by_method, table.numbers.at(places[i]).method());
  }
  return out;
}

/// Runs of the competitors that share one with competitor `i`: what its number could be over.
std::size_t possible(const Lane& lane, std::size_t i) {
  std::set<std::string> out;
  for (const ByRun& other : lane.competitors) {
    const bool shares = std::ranges::any_of(
        other, [&](const auto& run) { return lane.competitors[i].contains(run.first); });
    if (!shares) continue;
    for (const auto& [run, value] : other) out.insert(run);
  }
  return out.size();
}

/// Marks the best along every column (or every row) of the finished table.
void mark(Table& out, const Builder& table, bool along_columns, const RankingOptions& options) {
  const std::size_t lanes = along_columns ? out.columns.size() : out.rows.size();
  const std::size_t entries = along_columns ? out.rows.size() : out.columns.size();
  bool is_marked = false;
  std::string why_none;
  for (std::size_t l = 0; l < lanes; ++l) {
    std::vector<Place> places;
    for (std::size_t i = 0; i < entries; ++i) {
      places.push_back(along_columns ? Place{i, l} : Place{l, i});
    }
    const Lane all = lane(table, places, along_columns);
    const Marks marks = all.better == Better::neither
                            ? Marks{std::vector<Mark>(entries, Mark::none), ""}
                            : mark_best(all, options);
    if (!marks.why_none.empty()) why_none = marks.why_none;
    for (std::size_t i = 0; i < entries; ++i) {
      TableCell& cell = out.cells[places[i].first][places[i].second];
      cell.mark = marks.marks[i];
      is_marked = is_marked || cell.mark != Mark::none;
      const auto values = static_cast<std::size_t>(std::ranges::count_if(
          all.competitors[i], [](const auto& run) { return run.second.has_value(); }));
      const std::size_t most = possible(all, i);
      if (cell.value && values < most) cell.possible = cell.records + most - values;
    }
  }
  if (is_marked) {
    out.notes.insert(out.notes.begin(),
                     "marked: best, and second best, where it is proven better than all others, as "
                     "compare tests it");
  } else if (!why_none.empty()) {
    out.notes.push_back("no best is marked: " + why_none);
  }
}

/// What a reader must know of the averages.
void explain_averages(Table& out, const Builder& table) {
  std::size_t most = 1;
  bool has_gain = false;
  for (const auto& [place, numbers] : table.numbers) {
    most = std::max(most, numbers.size());
    has_gain = has_gain || numbers.is_gain();
  }
  if (most < 2) return;
  std::string text = "each number is the mean of up to " + std::to_string(most) + " cells";
  if (has_gain) text += "; gain is 1 - the geometric mean ratio to the baseline";
  out.notes.insert(out.notes.begin(), text);
}

Table finish(const Builder& table,
             const std::string& title,
             const TableSpec& spec,
             const RankingOptions& options) {
  Table out{title, "", table.columns.names(), table.rows.names(), {}, table.notes};
  const std::vector<std::string> missing = grouped(table.missing);
  out.notes.insert(out.notes.end(), missing.begin(), missing.end());
  if (const std::string counts = table.counts.text(out.columns); !counts.empty()) {
    out.notes.push_back("numbers of other counts than the judged poses (pairs): " + counts);
  }
  if (!table.oracle_sequences.empty()) {
    std::string names;
    for (const std::string& name : table.oracle_sequences)
      names += (names.empty() ? "" : ", ") + name;
    out.notes.push_back("closures are oracle, measured in the reference: " + names);
  }
  explain_averages(out, table);
  for (const std::string& name : spec.rows) out.corner += (out.corner.empty() ? "" : ", ") + name;
  for (std::size_t r = 0; r < out.rows.size(); ++r) {
    std::vector<TableCell> line(out.columns.size());
    for (std::size_t c = 0; c < out.columns.size(); ++c) {
      if (const auto whole = table.row_status.find(r); whole != table.row_status.end()) {
        line[c].status = whole->second;
      }
      if (const auto own = table.status.find({r, c}); own != table.status.end()) {
        line[c].status = own->second;
      }
      const auto found = table.numbers.find({r, c});
      if (found == table.numbers.end()) continue;
      line[c].value = found->second.average();
      line[c].records = found->second.size();
      if (!line[c].value) line[c].status = "undefined";
    }
    out.cells.push_back(std::move(line));
  }
  // Methods compete; a best sequence means nothing.
  if (std::ranges::count(spec.rows, "method") > 0) mark(out, table, true, options);
  if (spec.columns == std::vector<std::string>{"method"}) mark(out, table, false, options);
  return out;
}

/// Numbers made by different rules never share a table cell: several protocols split the tables
/// unless the spec already tells them apart.
TableSpec telling_protocols_apart(TableSpec spec, const std::vector<Record>& records) {
  for (const auto* names : {&spec.rows, &spec.columns, &spec.split}) {
    if (std::ranges::count(*names, "protocol") > 0) return spec;
  }
  const std::string* first = nullptr;
  for (const Record& record : records) {
    if (record.metric.empty()) continue;
    if (first == nullptr) first = &record.protocol;
    if (record.protocol == *first) continue;
    spec.split.emplace_back("protocol");
    break;
  }
  return spec;
}

}  // namespace

std::vector<Table> pivot(const std::vector<Record>& records,
                         const TableSpec& given,
                         const RankingOptions& options) {
  const TableSpec spec = telling_protocols_apart(given, records);
  NameOrder titles;
  std::vector<Builder> builders;
  const auto builder = [&](const std::string& title) -> Builder& {
    const std::size_t index = titles.index(title);
    if (index == builders.size()) builders.emplace_back();
    return builders[index];
  };
  const auto shown = [&](const Record& record) {
    return spec.show.empty() || std::ranges::count(spec.show, field(record, "score")) > 0;
  };
  for (const Record& record : records) {
    if (!record.metric.empty() && shown(record))
      add(builder(fields_joined(record, spec.split, ", ")), record, spec);
  }
  // A cell without any score belongs into every table of its sequence.
  for (const Record& record : records) {
    if (!record.metric.empty()) continue;
    const std::string own = fields_joined(record, spec.split, ", ");
    bool placed = false;
    for (std::size_t t = 0; t < builders.size(); ++t) {
      if (titles.names()[t].starts_with(own)) {
        add(builders[t], record, spec);
        placed = true;
      }
    }
    if (!placed) add(builder(own), record, spec);
  }
  if (builders.empty()) throw InputError("the table is empty: no row is left to show");
  std::vector<Table> out;
  for (std::size_t t = 0; t < builders.size(); ++t) {
    out.push_back(finish(builders[t], titles.names()[t], spec, options));
  }
  return out;
}

}  // namespace loopbench
