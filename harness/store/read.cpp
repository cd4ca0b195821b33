#include "harness/store/read.hpp"

#include <unordered_map>

#include "harness/store/open.hpp"

namespace loopbench {
namespace {

std::map<std::string, std::string> read_pairs(const std::filesystem::path& file,
                                              const std::string& table) {
  Database database = open_store(file);
  Statement rows = database.prepare("SELECT key, value FROM " + table);
  std::map<std::string, std::string> out;
  while (rows.step()) {
    std::string key = rows.text();
    out.emplace(std::move(key), rows.text());
  }
  return out;
}

template <class T>
std::optional<T> maybe(Statement& row, T (Statement::*read)()) {
  const bool none = row.is_null();
  const T value = (row.*read)();
  return none ? std::nullopt : std::optional<T>(value);
}

/// "LABEL" or "LABEL (repeat N)" from the next two columns.
std::string sequence_label(Statement& row) {
  const std::string label = row.text();
  const std::int64_t repeat = row.integer();
  return repeat > 0 ? label + " (repeat " + std::to_string(repeat) + ")" : label;
}

/// Calls `add` with the record and a statement at the column after the cell's id, for every row.
template <class Add>
void add_details(Database& database,
                 const std::string& columns_and_table,
                 std::unordered_map<std::int64_t, CellRecord*>& by_id,
                 Add add) {
  Statement rows = database.prepare("SELECT cell, " + columns_and_table + " ORDER BY rowid");
  while (rows.step()) {
    if (const auto found = by_id.find(rows.integer()); found != by_id.end()) {
      add(*found->second, rows);
    }
  }
}

}  // namespace

std::vector<Record> read_records(const std::filesystem::path& file) {
  Database database = open_store(file);
  // A declined or failed cell has no score: the left join keeps it, with empty score columns.
  Statement rows = database.prepare(R"sql(
    SELECT c.position, c.sequence, c.repeat, c.method, c.closures, c.oracle_closures, c.oracle,
           c.seconds_median * 1000, s.protocol, s.protocol_version, s.times, s.metric, s.relation,
           s.axis, s.unit,
           s.count, s.rmse, s.mean, s.median, s.std, s.min, s.max, s.sse, s.pairs, s.possible,
           -- An incomplete cell may be complete at other times: its scores know.
           CASE WHEN c.status IN ('ok', 'incomplete') THEN coalesce(s.status, c.status)
                ELSE c.status END,
           CASE WHEN c.why = '' OR c.status = 'incomplete' THEN coalesce(s.why, c.why)
                ELSE c.why END
    FROM cell c LEFT JOIN score s ON s.cell = c.id WHERE c.position IS NOT NULL
    ORDER BY c.position, s.rowid)sql");
  std::vector<Record> out;
  while (rows.step()) {
    Record r;
    r.cell = rows.integer();
    r.sequence = rows.text();
    r.repeat = rows.integer();
    r.method = rows.text();
    r.closures = rows.text();
    r.oracle_closures = rows.integer() != 0;
    r.oracle = rows.integer() != 0;
    r.milliseconds = rows.real();
    r.protocol = rows.text();
    r.protocol_version = rows.text();
    r.times = rows.text();
    r.metric = rows.text();
    r.relation = rows.text();
    r.axis = rows.text();
    r.unit = rows.text();
    r.statistics.count = static_cast<std::size_t>(rows.integer());
    for (double* number : {&r.statistics.rmse,
                           &r.statistics.mean,
                           &r.statistics.median,
                           &r.statistics.std,
                           &r.statistics.min,
                           &r.statistics.max,
                           &r.statistics.sse}) {
      *number = rows.real();
    }
    r.pairs = rows.integer();
    r.possible = rows.integer();
    r.status = rows.text();
    r.why = rows.text();
    out.push_back(std::move(r));
  }
  return out;
}

std::vector<CellRecord> read_cells(const std::filesystem::path& file) {
  Database database = open_store(file);
  Statement rows = database.prepare(
      "SELECT c.id, c.position, c.key, c.build, c.sequence, c.repeat, c.method, c.dataset_options, "
      "c.method_options, c.closures, c.oracle_closures, c.oracle, s.keyframes, s.closures, "
      "c.worker, c.runs, c.seconds_median, c.seconds_min, c.seconds_max, c.cpu_seconds_median, "
      "c.peak_memory, c.added_memory, c.allocations, c.status, c.signal, c.why "
      "FROM cell c LEFT JOIN sequence s ON s.asked = c.asked "
      "WHERE c.position IS NOT NULL ORDER BY c.position");
  std::vector<CellRecord> out;
  std::vector<std::int64_t> ids;
  while (rows.step()) {
    ids.push_back(rows.integer());
    CellRecord& c = out.emplace_back();
    c.position = rows.integer();
    c.key = rows.text();
    c.build = rows.text();
    c.sequence = rows.text();
    c.repeat = rows.integer();
    c.method = rows.text();
    c.dataset_options = rows.text();
    c.method_options = rows.text();
    c.closures = rows.text();
    c.oracle_closures = rows.integer() != 0;
    c.oracle = rows.integer() != 0;
    c.keyframes = rows.integer();
    c.closure_count = rows.integer();
    c.worker = rows.text();
    c.runs = rows.integer();
    c.seconds = rows.real();
    c.seconds_min = rows.real();
    c.seconds_max = rows.real();
    c.cpu_seconds = maybe(rows, &Statement::real);
    c.peak_memory = maybe(rows, &Statement::integer);
    c.added_memory = maybe(rows, &Statement::integer);
    c.allocations = maybe(rows, &Statement::integer);
    c.status = rows.text();
    c.signal = rows.text();
    c.why = rows.text();
  }
  std::unordered_map<std::int64_t, CellRecord*> by_id;
  for (std::size_t i = 0; i < out.size(); ++i) by_id.emplace(ids[i], &out[i]);
  add_details(database, "name, seconds FROM phase", by_id, [](CellRecord& c, Statement& row) {
    std::string name = row.text();
    c.phases.push_back({std::move(name), row.real()});
  });
  add_details(database, "name, value FROM count", by_id, [](CellRecord& c, Statement& row) {
    std::string name = row.text();
    c.counts.push_back({std::move(name), row.real()});
  });
  add_details(database, "text FROM note", by_id, [](CellRecord& c, Statement& row) {
    c.notes.push_back(row.text());
  });
  return out;
}

std::map<std::string, std::string> read_run(const std::filesystem::path& file) {
  return read_pairs(file, "run");
}

std::map<std::string, std::string> read_provenance(const std::filesystem::path& file) {
  return read_pairs(file, "provenance");
}

std::map<std::string, std::vector<InputFile>> read_inputs(const std::filesystem::path& file) {
  Database database = open_store(file);
  Statement rows = database.prepare(
      "SELECT DISTINCT c.sequence, c.repeat, i.number, i.path, i.bytes, i.hash FROM cell c "
      "JOIN input i ON i.asked = c.asked WHERE c.position IS NOT NULL ORDER BY 1, 2, 3");
  std::map<std::string, std::vector<InputFile>> out;
  while (rows.step()) {
    const std::string label = sequence_label(rows);
    rows.integer();  // number
    InputFile input;
    input.path = rows.text();
    input.bytes = static_cast<std::uint64_t>(rows.integer());
    input.hash = rows.text();
    out[label].push_back(std::move(input));
  }
  return out;
}

std::map<std::string, std::string> read_dataset_options(const std::filesystem::path& file) {
  Database database = open_store(file);
  Statement rows = database.prepare(
      "SELECT DISTINCT c.sequence, c.repeat, s.options FROM cell c "
      "JOIN sequence s ON s.asked = c.asked WHERE c.position IS NOT NULL");
  std::map<std::string, std::string> out;
  while (rows.step()) {
    const std::string label = sequence_label(rows);
    out[label] = rows.text();
  }
  return out;
}

}  // namespace loopbench
