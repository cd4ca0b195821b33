#include "harness/export/pivot.hpp"

#include <algorithm>
#include <map>

#include "datasets/core/error.hpp"
#include "harness/compare/name_order.hpp"
#include "harness/export/better.hpp"
#include "harness/export/notes.hpp"

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
  return r.times + " / " + r.metric + " / " + r.relation + " / " + r.axis + " [" + r.unit + "]";
}

/// What is compared where the best is marked.
struct CellContest {
  ByRun runs;
  Better better = Better::neither;
};

struct Builder {
  NameOrder rows;
  NameOrder columns;
  std::map<std::pair<std::size_t, std::size_t>, TableCell> cells;
  std::map<std::pair<std::size_t, std::size_t>, std::string> kinds;
  std::map<std::pair<std::size_t, std::size_t>, CellContest> contests;
  std::size_t most = 1;  // records averaged into one cell
  std::map<std::size_t, std::pair<std::size_t, std::size_t>> counts;  // see count_errors
  std::map<std::size_t, std::string> row_status;  // declined or failed as a whole
  std::vector<Missing> missing;
  std::vector<std::string> notes;

  void note(const std::string& text) {
    if (std::ranges::count(notes, text) == 0) notes.push_back(text);
  }
};

/// Least and most errors behind the numbers of a column, where they are not the judged poses.
void count_errors(Builder& table, std::size_t column, const Record& record) {
  const std::size_t count = record.statistics.count;
  if (count < 2 || count == static_cast<std::size_t>(record.pairs)) return;
  auto& [least, most] = table.counts.try_emplace(column, count, count).first->second;
  least = std::min(least, count);
  most = std::max(most, count);
}

/// "rpe 1 s [m]: 396 to 398; ..."; empty: every number is of the judged poses.
std::string counts_text(const Builder& table) {
  std::string out;
  for (const auto& [column, range] : table.counts) {
    const auto& [least, most] = range;
    out += (out.empty() ? "" : "; ") + table.columns.names()[column] + ": " + std::to_string(least);
    if (most != least) out += " to " + std::to_string(most);
  }
  return out;
}

void add(Builder& table, const Record& record, const TableSpec& spec) {
  std::string name = fields_joined(record, spec.rows, ", ");
  if (record.oracle) {
    name += " (oracle)";
    table.note("oracle: the method was shown the reference");
  }
  const std::size_t row = table.rows.index(name);
  if (record.oracle_closures) table.note("closures are oracle: measured in the reference");
  if (record.status != "ok") {
    // Too little coverage is one reason for every metric; an undefined number names itself.
    const bool is_whole = record.metric.empty() || record.status == "incomplete";
    const std::string what = is_whole ? "" : fields_joined(record, {"metric", "relation"}, " ");
    table.missing.push_back({name, what, record.status, record.why});
  } else if (record.metric.empty() && !record.why.empty()) {
    table.note(name + ": " + record.why);
  }
  if (record.metric.empty()) {
    if (record.status != "ok") table.row_status[row] = record.status;
    return;
  }
  const std::string unit = record.unit.empty() ? "" : " [" + record.unit + "]";
  const std::size_t column = table.columns.index(fields_joined(record, spec.columns, " ") + unit);
  TableCell& cell = table.cells[{row, column}];
  const std::string own = kind(record);
  if (const std::string& other = table.kinds.emplace(std::pair{row, column}, own).first->second;
      other != own) {
    throw InputError("a cell of this table would average '" + other + "' with '" + own +
                     "'; add the column that tells them apart");
  }
  if (record.status != "ok") {
    cell.status = record.status;
    return;
  }
  count_errors(table, column, record);
  const double sum = cell.value.value_or(0.0) * static_cast<double>(cell.records);
  ++cell.records;
  table.most = std::max(table.most, cell.records);
  const double own_value = value(record, spec.value);
  cell.value = (sum + own_value) / static_cast<double>(cell.records);
  CellContest& contest = table.contests[{row, column}];
  if (record.oracle) return;  // who was shown the reference does not compete
  contest.runs[record.sequence + "\n" + std::to_string(record.repeat)] = own_value;
  contest.better = better(record);
}

/// Marks the best along every column (or every row) of the finished table.
void mark(Table& out, const Builder& table, bool along_columns, double alpha) {
  const std::size_t lanes = along_columns ? out.columns.size() : out.rows.size();
  const std::size_t entries = along_columns ? out.rows.size() : out.columns.size();
  bool is_marked = false;
  std::string why_none;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    std::vector<ByRun> competitors(entries);
    Better way = Better::neither;
    const auto at = [&](std::size_t i) {
      return along_columns ? std::pair{i, lane} : std::pair{lane, i};
    };
    for (std::size_t i = 0; i < entries; ++i) {
      const auto found = table.contests.find(at(i));
      if (found == table.contests.end()) continue;
      competitors[i] = found->second.runs;
      way = found->second.better;
    }
    if (way == Better::neither) continue;
    const Marks marks = mark_best(competitors, way == Better::higher, alpha);
    if (!marks.why_none.empty()) why_none = marks.why_none;
    for (std::size_t i = 0; i < entries; ++i) {
      out.cells[at(i).first][at(i).second].mark = marks.marks[i];
      is_marked = is_marked || marks.marks[i] != Mark::none;
    }
  }
  if (is_marked) {
    out.notes.insert(out.notes.begin(),
                     "marked: best, and second best, where paired Wilcoxon tests over the runs "
                     "tell it from all others (Holm over all pairs)");
  } else if (!why_none.empty()) {
    out.notes.push_back("no best is marked: " + why_none);
  }
}

Table finish(const Builder& table, const std::string& title, const TableSpec& spec, double alpha) {
  Table out{title, "", table.columns.names(), table.rows.names(), {}, table.notes};
  const std::vector<std::string> missing = grouped(table.missing);
  out.notes.insert(out.notes.end(), missing.begin(), missing.end());
  if (const std::string counts = counts_text(table); !counts.empty()) {
    out.notes.push_back("numbers of other counts than the judged poses (pairs): " + counts);
  }
  if (table.most > 1) {
    out.notes.insert(out.notes.begin(),
                     "each number is the mean of up to " + std::to_string(table.most) + " cells");
  }
  for (const std::string& name : spec.rows) out.corner += (out.corner.empty() ? "" : ", ") + name;
  for (std::size_t r = 0; r < out.rows.size(); ++r) {
    std::vector<TableCell> line(out.columns.size());
    for (std::size_t c = 0; c < out.columns.size(); ++c) {
      if (const auto found = table.cells.find({r, c}); found != table.cells.end()) {
        line[c] = found->second;
      } else if (const auto whole = table.row_status.find(r); whole != table.row_status.end()) {
        line[c].status = whole->second;
      }
    }
    out.cells.push_back(std::move(line));
  }
  // Methods compete; a best sequence means nothing.
  if (std::ranges::count(spec.rows, "method") > 0) mark(out, table, true, alpha);
  if (spec.columns == std::vector<std::string>{"method"}) mark(out, table, false, alpha);
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

std::vector<Table> pivot(const std::vector<Record>& records, const TableSpec& given, double alpha) {
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
    out.push_back(finish(builders[t], titles.names()[t], spec, alpha));
  }
  return out;
}

}  // namespace loopbench
