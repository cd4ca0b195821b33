#include "harness/store/cell_rows.hpp"

#include <algorithm>

#include "datasets/core/error.hpp"
#include "harness/store/digest.hpp"

namespace loopbench::harness {
namespace {

constexpr const char* kDetailTables[] = {
    "score_value", "phase", "count", "note", "section", "trace"};

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

void check_scores(Database& database, const ScoreDefinitions& definitions, CellRows& rows) {
  std::vector<ScoresDigest> digests(rows.cells.size());
  std::size_t cell = 0;
  Statement row = database.prepare(std::string("SELECT ") + kScoreColumns +
                                   " FROM score_value ORDER BY cell, number");
  while (row.step()) {
    const std::int64_t id = row.integer();
    while (cell < rows.cells.size() && rows.cells[cell].id < id) ++cell;
    if (cell == rows.cells.size()) break;
    if (rows.cells[cell].id != id) continue;
    row.integer();  // number
    digests[cell].add(row, definitions.find(row.integer()));
  }
  const std::size_t number = detail_number("score_value");
  for (std::size_t i = 0; i < rows.cells.size(); ++i) {
    if (digests[i].value() != rows.cells[i].details[number]) rows.cells[i].intact = false;
  }
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
  const auto position = [&](std::size_t i) { return rows.cells[i].position; };
  if (!std::ranges::is_sorted(out, {}, position)) std::ranges::stable_sort(out, {}, position);
  return out;
}

}  // namespace loopbench::harness
