#include "harness/store/cell_rows.hpp"

#include <algorithm>

#include "datasets/core/error.hpp"
#include "harness/store/digest.hpp"
#include "harness/store/row_bytes.hpp"
#include "harness/store/write_digests.hpp"

namespace loopbench::harness {
namespace {

constexpr const char* kDetailTables[] = {"scores", "phase", "count", "note", "section", "trace"};

template <class T>
std::optional<T> maybe(Statement& row, T (Statement::*read)()) {
  const bool none = row.is_null();
  const T value = (row.*read)();
  return none ? std::nullopt : std::optional<T>(value);
}

/// A text of a column; neighbouring cells mostly have the same.
class SharedColumn {
 public:
  const SharedText& read(RowBytes& row) {
    const std::string_view text = row.view();
    if (last_.text() != text) last_ = text;
    return last_;
  }

 private:
  SharedText last_;
};

/// All columns that tables need; `row` is at its first column.
CellRecord record_of(Statement& row, WithRecords with) {
  CellRecord c;
  const auto text = [&]() -> SharedText {
    if (with == WithRecords::yes) return row.view();
    row.skip();
    return {};
  };
  row.skip();  // id
  c.position = row.integer();
  if (with == WithRecords::yes) {
    c.key = row.text();
  } else {
    row.skip();
  }
  c.build = text();
  row.skip();  // sequence_key
  row.skip();  // made
  c.sequence = row.view();
  c.repeat = row.integer();
  c.method = row.view();
  c.dataset_options = text();
  c.method_options = text();
  c.closures = row.view();
  c.oracle_closures = row.integer() != 0;
  c.oracle = row.integer() != 0;
  c.worker = row.view();
  c.runs = row.integer();
  c.seconds = row.real();
  c.seconds_min = row.real();
  c.seconds_max = row.real();
  c.cpu_seconds = maybe(row, &Statement::real);
  c.peak_memory = maybe(row, &Statement::integer);
  c.added_memory = maybe(row, &Statement::integer);
  c.allocations = maybe(row, &Statement::integer);
  c.status = row.view();
  c.signal = text();
  c.why = text();
  return c;
}

class RowReader {
 public:
  explicit RowReader(CellRows& out) : out_(out) {}

  void add(Statement& statement) {
    RowBytes row(statement.bytes_of_columns(0, statement.columns()));
    CellRow& cell = out_.cells.emplace_back();
    const char* const begin = row.rest().data();
    cell.id = row.integer();
    cell.placed = !row.is_null();
    cell.position = row.integer();
    cell.key = hash_of(row.view());
    row.skip();  // build
    cell.sequence_key = sequence_key_.read(row);
    row.skip();  // made
    cell.sequence = sequence_.read(row);
    cell.repeat = row.integer();
    cell.method = method_.read(row);
    row.skip();  // dataset_options
    row.skip();  // method_options
    cell.closures = closures_.read(row);
    cell.oracle_closures = row.integer() != 0;
    cell.oracle = row.integer() != 0;
    row.skip();  // worker
    row.skip();  // runs
    cell.seconds = row.real();
    for (int i = 0; i < 6; ++i) row.skip();  // seconds_min to allocations
    cell.status = status_.read(row);
    row.skip();  // signal
    cell.why = why_.read(row);
    cell.failed_scores = row.integer();
    for (Hash& digest : cell.details) digest = parsed_digest(row.view());
    RowsDigest all;
    all.add({begin, static_cast<std::size_t>(row.rest().data() - begin)});
    cell.digest = parsed_digest(row.view());
    cell.intact = all.value() == cell.digest;
  }

 private:
  CellRows& out_;
  SharedColumn sequence_key_;
  SharedColumn sequence_;
  SharedColumn method_;
  SharedColumn closures_;
  SharedColumn status_;
  SharedColumn why_;
};

std::string cell_label(const std::string& sequence,
                       std::int64_t repeat,
                       const std::string& method) {
  const std::string number = repeat > 0 ? " (repeat " + std::to_string(repeat) + ")" : "";
  std::string out = sequence + number + " / " + method;
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 0x20) c = '?';  // in a damaged name
  }
  return out;
}

}  // namespace

std::size_t detail_number(const std::string& table) {
  return static_cast<std::size_t>(std::ranges::find(kDetailTables, table) - kDetailTables);
}

CellRows read_cell_rows(Database& database, WithRecords with) {
  CellRows out;
  RowReader reader(out);
  SumOfDigests sum;
  Statement rows = database.prepare("SELECT * FROM cell NOT INDEXED ORDER BY id");
  while (rows.step()) {
    reader.add(rows);
    if (with != WithRecords::no) {
      rows.rewind();
      out.records.push_back(record_of(rows, with));
    }
    sum.add(out.cells.back().digest);
  }
  out.complete = sum.text() == written_digest(database, "cell");
  return out;
}

void read_details(Database& database,
                  const std::string& table,
                  CellRows& rows,
                  const std::function<void(std::size_t cell, Statement& row)>& each) {
  std::size_t cell = 0;  // rows of one cell mostly follow each other
  std::vector<RowsDigest> digests(rows.cells.size());
  // Not by an index, which can be damaged and miss rows.
  Statement row = database.prepare("SELECT * FROM " + table + " NOT INDEXED ORDER BY rowid");
  while (row.step()) {
    const std::int64_t id = row.integer();
    if (cell < rows.cells.size() && rows.cells[cell].id < id) ++cell;
    if (cell == rows.cells.size() || rows.cells[cell].id != id) {
      cell = static_cast<std::size_t>(std::ranges::lower_bound(rows.cells, id, {}, &CellRow::id) -
                                      rows.cells.begin());
      if (cell == rows.cells.size() || rows.cells[cell].id != id) continue;
    }
    digests[cell].add(row, 1, row.columns());
    if (each) each(cell, row);
  }
  const std::size_t number = detail_number(table);
  for (std::size_t i = 0; i < rows.cells.size(); ++i) {
    if (digests[i].value() != rows.cells[i].details[number]) rows.cells[i].intact = false;
  }
}

void check_scores(Database& database, const ScoreLists& lists, CellRows& rows) {
  read_details(database, "scores", rows, [&](std::size_t cell, Statement& row) {
    const std::string_view key = row.view();
    if (list_of(lists, key, row.view()) == nullptr) rows.cells[cell].intact = false;
  });
}

void throw_damaged(const std::filesystem::path& file, const std::string& what) {
  throw InputError(file.string() + ": is damaged: " + what +
                   " corrupted; run 'loopbench run' with its config and '--retry damaged' "
                   "to recompute it");
}

void require_intact(const CellRows& rows, const std::filesystem::path& file) {
  const auto damaged = std::ranges::count(rows.cells, false, &CellRow::intact);
  if (damaged == 0 && rows.complete) return;
  if (damaged == 0) throw_damaged(file, "its list of cells is");
  const auto first = std::ranges::find(rows.cells, false, &CellRow::intact);
  throw_damaged(file,
                label_of(*first) +
                    (damaged == 1 ? " is" : " and " + std::to_string(damaged - 1) + " more are"));
}

std::string label_of(const CellRecord& cell) {
  return cell_label(cell.sequence, cell.repeat, cell.method);
}

std::string label_of(const CellRow& cell) {
  return cell_label(cell.sequence, cell.repeat, cell.method);
}

std::vector<std::size_t> in_order(const CellRows& rows) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < rows.cells.size(); ++i) {
    if (rows.cells[i].placed) out.push_back(i);
  }
  std::ranges::stable_sort(out, {}, [&](std::size_t i) { return rows.cells[i].position; });
  return out;
}

}  // namespace loopbench::harness
