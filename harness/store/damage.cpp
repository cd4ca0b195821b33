#include "harness/store/damage.hpp"

#include <algorithm>

#include "harness/store/cell_writer.hpp"
#include "harness/store/open.hpp"

namespace loopbench::harness {

std::vector<StoredCell> checked_cells(Database& database, bool traces) {
  std::vector<StoredCell> out = read_cell_rows(database);
  check_scores(database, out);
  check_reports(database, out);
  if (traces) check_traces(database, out);
  return out;
}

std::vector<std::string> remove_damaged(Database& database, std::vector<StoredCell>& cells) {
  std::vector<std::string> out;
  for (const StoredCell& cell : cells) {
    if (cell.intact) continue;
    out.push_back(label_of(cell));
    remove_cell(database, cell.id);
  }
  std::erase_if(cells, [](const StoredCell& cell) { return !cell.intact; });
  if (written_cells(database) == std::ssize(cells)) return out;
  database.prepare("INSERT OR REPLACE INTO run VALUES ('cells', ?)")
      .bind(std::to_string(cells.size()))
      .run();
  for (const char* table : {"score_value", "phase", "count", "note", "section", "trace"}) {
    // Otherwise they would belong to a later cell with the same id.
    database.execute(std::string("DELETE FROM ") + table +
                     " WHERE cell NOT IN (SELECT id FROM cell)");
  }
  database.execute(
      "DELETE FROM score_definition WHERE id NOT IN (SELECT definition FROM score_value)");
  return out;
}

void require_intact_store(const std::filesystem::path& file) {
  Database database = open_store(file);
  require_intact(database, checked_cells(database, true));
}

}  // namespace loopbench::harness
