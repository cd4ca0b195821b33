#include "harness/store/cell_rows.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <future>
#include <span>

#include "datasets/core/error.hpp"

namespace loopbench::harness {
namespace {

/// From this number of cells on, half of the scores are read through a second connection.
constexpr std::size_t kCellsWorthAThread = 8192;

/// A text of a column; neighbouring cells mostly have the same.
class SharedColumn {
 public:
  const SharedText& read(Statement& row) {
    const std::string_view text = row.view();
    if (last_.text() != text) last_ = text;
    return last_;
  }

 private:
  SharedText last_;
};

/// Reads rows of kCellColumns after id, checksum and report_checksum.
class CellReader {
 public:
  explicit CellReader(Database& database) : sequences_(sequence_checksums(database)) {}

  StoredCell read(Statement& row) {
    StoredCell c;
    c.id = row.integer();
    c.checksum = std::bit_cast<Checksum>(row.integer());
    c.report_checksum = std::bit_cast<Checksum>(row.integer());
    const std::optional<std::int64_t> position = row.maybe_integer();
    c.placed = position.has_value();
    c.position = position.value_or(0);
    c.key = row.text();
    c.build = build_.read(row);
    c.sequence_key = sequence_key_.read(row);
    c.provenance_key = provenance_key_.read(row);
    c.sequence = sequence_.read(row);
    c.repeat = row.integer();
    c.method = method_.read(row);
    c.dataset_options = dataset_options_.read(row);
    c.method_options = method_options_.read(row);
    c.closures = closures_.read(row);
    c.oracle_closures = row.integer() != 0;
    c.oracle = row.integer() != 0;
    c.worker = worker_.read(row);
    c.runs = row.integer();
    c.seconds = row.real();
    c.seconds_min = row.real();
    c.seconds_max = row.real();
    c.cpu_seconds = row.maybe_real();
    c.peak_memory = row.maybe_integer();
    c.added_memory = row.maybe_integer();
    const std::optional<Status> status = from_text<Status>(row.text());
    c.status = status.value_or(Status::failed);
    c.signal = signal_.read(row);
    c.why = why_.read(row);
    c.failed_scores = row.integer();
    c.intact = status.has_value();
    const auto sequence = sequences_.find(c.sequence_key);
    c.own = checksum_of_cell(row, sequence == sequences_.end() ? 0 : sequence->second);
    return c;
  }

 private:
  std::unordered_map<std::string, Checksum> sequences_;
  SharedColumn build_, sequence_key_, provenance_key_, sequence_, method_, dataset_options_,
      method_options_, closures_, worker_, signal_, why_;
};

/// Counts the scores of the cells. Returns the indices of those that do not match their checksum.
std::vector<std::size_t> wrong_scores(Database& database, std::span<StoredCell> cells) {
  std::vector<std::size_t> out;
  if (cells.empty()) return out;
  const auto definitions = definition_checksums(database);
  Statement row = database.prepare(std::string("SELECT ") + kScoreColumns +
                                   " FROM score_value WHERE cell >= ? AND cell <= ? ORDER BY cell, "
                                   "number");
  row.bind(cells.front().id).bind(cells.back().id);
  bool has_row = row.step();
  std::int64_t id = has_row ? row.integer() : 0;
  const auto next = [&] {
    has_row = row.step();
    if (has_row) id = row.integer();
  };
  std::string bytes;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    bytes.clear();
    cells[i].score_count = 0;
    while (has_row && id < cells[i].id) next();
    for (; has_row && id == cells[i].id; next()) {
      add_score(row, row.integer(), definitions, bytes);
      ++cells[i].score_count;
    }
    if (cells[i].own + checksum_of(bytes) != cells[i].checksum) out.push_back(i);
  }
  return out;
}

}  // namespace

std::vector<StoredCell> read_cell_rows(Database& database) {
  std::vector<StoredCell> out;
  CellReader reader(database);
  Statement rows = database.prepare(std::string("SELECT id, checksum, report_checksum, ") +
                                    kCellColumns + " FROM cell ORDER BY id");
  while (rows.step()) out.push_back(reader.read(rows));
  return out;
}

void check_scores(Database& database, std::vector<StoredCell>& cells) {
  const std::span<StoredCell> all(cells);
  if (all.size() < kCellsWorthAThread) {
    for (const std::size_t i : wrong_scores(database, all)) cells[i].intact = false;
    return;
  }
  const std::size_t half = all.size() / 2;
  // The second connection can see another state of the store, so the first one checks its findings.
  std::future<std::vector<std::size_t>> upper = std::async(std::launch::async, [&] {
    Database other(database.file(), Database::Mode::read);
    return wrong_scores(other, all.subspan(half));
  });
  for (const std::size_t i : wrong_scores(database, all.first(half))) cells[i].intact = false;
  for (const std::size_t i : upper.get()) {
    if (!wrong_scores(database, all.subspan(half + i, 1)).empty()) cells[half + i].intact = false;
  }
}

void check_reports(Database& database, std::vector<StoredCell>& cells, const ReportVisit& visit) {
  std::vector<Checksum> sums(cells.size(), 0);
  for (const char* table : kReportTables) {
    const bool is_trace = table == std::string_view("trace");
    Statement row =
        database.prepare(report_query(table, is_trace ? "ORDER BY cell" : "ORDER BY cell, number"));
    std::size_t cell = 0;
    std::string bytes;
    const auto finish = [&] {
      if (cell < cells.size()) sums[cell] += checksum_of_report(table, bytes);
      bytes.clear();
    };
    while (row.step()) {
      const std::int64_t id = row.integer();
      if (cell < cells.size() && cells[cell].id < id) {
        finish();
        while (cell < cells.size() && cells[cell].id < id) ++cell;
      }
      if (cell == cells.size() || cells[cell].id != id) continue;
      row.append_columns(1, row.columns(), bytes);
      row.integer();  // number
      if (visit && !is_trace) visit(table, cell, row);
    }
    finish();
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (sums[i] != cells[i].report_checksum) cells[i].intact = false;
  }
}

void check_traces(Database& database, std::vector<StoredCell>& cells) {
  Statement row =
      database.prepare("SELECT cell, times, samples, checksum FROM trace ORDER BY cell");
  auto cell = cells.begin();
  while (row.step()) {
    const std::int64_t id = row.integer();
    while (cell != cells.end() && cell->id < id) ++cell;
    if (cell == cells.end() || cell->id != id) continue;
    const std::string times = row.text();
    const std::string_view samples = row.view();
    if (checksum_of_parts({times, samples}) != row.integer()) cell->intact = false;
  }
  Statement sequence = database.prepare(
      "SELECT sequence_key, reference, keyframes, closures, checksum FROM sequence_trace");
  while (sequence.step()) {
    const std::string key = sequence.text();
    const std::string reference = sequence.blob();
    const std::string keyframes = sequence.blob();
    const std::string closures = sequence.blob();
    if (checksum_of_parts({reference, keyframes, closures}) == sequence.integer()) continue;
    for (StoredCell& own : cells) {
      if (own.sequence_key == key) own.intact = false;
    }
  }
}

void throw_damaged(const std::string& file, const std::string& what) {
  throw InputError(file + ": is damaged: " + what +
                   " corrupted; 'loopbench run' with its config computes it again");
}

std::int64_t written_cells(Database& database) {
  Statement row = database.prepare("SELECT value FROM run WHERE key = 'cells'");
  return row.step() ? row.integer() : 0;
}

void require_intact(Database& database, const std::vector<StoredCell>& cells) {
  const auto damaged = std::ranges::count(cells, false, &StoredCell::intact);
  if (damaged > 0) {
    const auto first = std::ranges::find(cells, false, &StoredCell::intact);
    throw_damaged(database.file(),
                  label_of(*first) +
                      (damaged == 1 ? " is" : " and " + std::to_string(damaged - 1) + " more are"));
  }
  if (written_cells(database) != std::ssize(cells)) {
    throw_damaged(database.file(), "its table of cells is");
  }
}

std::string label_of(const CellRecord& cell) {
  const std::string number = cell.repeat > 0 ? " (repeat " + std::to_string(cell.repeat) + ")" : "";
  std::string out = cell.sequence + number + " / " + cell.method;
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 0x20) c = '?';  // in a damaged name
  }
  return out;
}

std::vector<std::size_t> in_order(const std::vector<StoredCell>& cells) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].placed) out.push_back(i);
  }
  const auto position = [&](std::size_t i) { return cells[i].position; };
  if (!std::ranges::is_sorted(out, {}, position)) std::ranges::stable_sort(out, {}, position);
  return out;
}

}  // namespace loopbench::harness
