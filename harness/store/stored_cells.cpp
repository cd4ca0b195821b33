#include "harness/store/stored_cells.hpp"

#include <algorithm>

#include "datasets/core/error.hpp"
#include "harness/store/schema.hpp"

namespace loopbench::harness {
namespace {

std::string cells_query(const std::string& columns) {
  return "SELECT " + columns + " FROM " + kCellsWithSequences;
}

/// Number of cells of the store according to its writers. A damaged page can lose cells.
std::int64_t written_cells(Database& database) {
  Statement row = database.prepare("SELECT value FROM run WHERE key = 'cells'");
  return row.step() ? row.integer() : 0;
}

std::string label_of(Database& database, std::int64_t id) {
  CellRecord cell;
  Statement row = database.prepare("SELECT sequence, repeat, method FROM cell WHERE id = ?");
  if (row.bind(id).step()) row.read(cell.sequence, cell.repeat, cell.method);
  return label_of(cell);
}

void require_none(Database& database, const std::vector<std::int64_t>& damaged) {
  if (damaged.empty()) return;
  const std::string more = std::to_string(damaged.size() - 1);
  throw_damaged(database.file(),
                label_of(database, damaged.front()) +
                    (damaged.size() == 1 ? " is" : " and " + more + " more are"));
}

/// Selects the ids of cells with another number of scores.
constexpr const char* kOtherScores =
    "SELECT id FROM cell WHERE scores <> (SELECT count(*) FROM score_value WHERE cell = cell.id)";

std::vector<std::int64_t> ids_of(Database& database, const std::string& query) {
  std::vector<std::int64_t> out;
  Statement row = database.prepare(query);
  while (row.step()) out.push_back(row.integer());
  return out;
}

}  // namespace

std::vector<StoredCell> read_stored_cells(Database& database) {
  std::vector<StoredCell> out;
  Statement row = database.prepare(
      cells_query(
          std::string("cell.id, ") + kCellColumns +
          ", keyframes, sequence.closures, content, group_name, checksum = " + cell_checksum()) +
      " ORDER BY cell.id");
  StoredCell c;
  SharedText unused;  // keys of sequence and provenance
  while (row.step()) {
    std::optional<std::int64_t> position;
    std::string status;
    row.read(c.id, position, c.key, c.build, unused, unused, c.sequence);
    row.read(c.repeat, c.method, c.dataset_options, c.method_options, c.closures);
    row.read(c.oracle_closures, c.oracle, c.worker, c.runs);
    row.read(c.seconds, c.seconds_min, c.seconds_max, c.cpu_seconds, c.peak_memory);
    row.read(c.added_memory, status, c.signal, c.why, c.failed_scores, c.scores, c.report_rows);
    row.read(c.keyframes, c.closure_count, c.content, c.group, c.intact);
    c.placed = position.has_value();
    c.position = position.value_or(0);
    c.status = from_text<Status>(status).value_or(Status::failed);
    out.push_back(c);
  }
  return out;
}

std::vector<StoredCell> read_intact_cells(Database& database) {
  std::vector<StoredCell> out = read_stored_cells(database);
  std::vector<std::int64_t> damaged;
  for (const StoredCell& cell : out) {
    if (!cell.intact) damaged.push_back(cell.id);
  }
  require_none(database, damaged);
  if (written_cells(database) != std::ssize(out)) {
    throw_damaged(database.file(), "its table of cells is");
  }
  std::erase_if(out, [](const StoredCell& cell) { return !cell.placed; });
  std::ranges::stable_sort(out, {}, &StoredCell::position);
  return out;
}

void require_all_scores(Database& database) {
  require_none(database, ids_of(database, kOtherScores));
}

std::vector<std::int64_t> damaged_cells(Database& database) {
  const auto differs = [](const std::string& checksum, const std::string& columns) {
    return checksum + " <> row_checksum(" + columns + ")";
  };
  std::string query = cells_query("cell.id") + " WHERE checksum <> " + cell_checksum() + " UNION " +
                      kOtherScores +
                      " UNION SELECT id FROM cell WHERE report_rows <> (SELECT count(*) FROM phase "
                      "WHERE cell = id) + (SELECT count(*) FROM count WHERE cell = id) + (SELECT "
                      "count(*) FROM note WHERE cell = id) + (SELECT count(*) FROM section WHERE "
                      "cell = id)";
  for (const CellTable& table : kCellTables) {
    query += std::string(" UNION SELECT cell FROM ") + table.name + " WHERE " +
             differs("checksum", table.columns);
  }
  query +=
      " UNION SELECT cell FROM score_value WHERE definition NOT IN (SELECT id FROM "
      "score_definition WHERE NOT " +
      differs("id", kDefinitionColumns) +
      ") UNION SELECT id FROM cell WHERE sequence_key IN (SELECT sequence_key FROM "
      "sequence_trace WHERE " +
      differs("checksum", kSequenceTraceColumns) + ")";
  return ids_of(database, query);
}

void require_intact(Database& database) {
  read_intact_cells(database);
  require_none(database, damaged_cells(database));
}

void throw_damaged(const std::string& file, const std::string& what) {
  throw InputError(file + ": is damaged: " + what +
                   " corrupted; 'loopbench run --retry damaged' with its config computes it again");
}

void remove_cell(Database& database, std::int64_t id) {
  for (const CellTable& table : kCellTables) {
    database.prepare(std::string("DELETE FROM ") + table.name + " WHERE cell = ?").bind(id).run();
  }
  database.prepare("DELETE FROM cell WHERE id = ?").bind(id).run();
}

void remove_orphans(Database& database) {
  Statement count = database.prepare("SELECT count(*) FROM cell");
  const std::int64_t cells = count.step() ? count.integer() : 0;
  if (written_cells(database) == cells) return;
  database.prepare("INSERT OR REPLACE INTO run VALUES ('cells', ?)")
      .bind(std::to_string(cells))
      .run();
  for (const CellTable& table : kCellTables) {
    database.execute(std::string("DELETE FROM ") + table.name +
                     " WHERE cell NOT IN (SELECT id FROM cell)");
  }
}

Statement checksum_update(Database& database) {
  return database.prepare("UPDATE cell SET checksum = (" + cells_query(cell_checksum()) +
                          " WHERE cell.id = ?1) WHERE id = ?1");
}

std::string label_of(const CellRecord& cell) {
  const std::string number = cell.repeat > 0 ? " (repeat " + std::to_string(cell.repeat) + ")" : "";
  std::string out = cell.sequence + number + " / " + cell.method;
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 0x20) c = '?';  // in a damaged name
  }
  return out;
}

}  // namespace loopbench::harness
