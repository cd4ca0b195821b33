#include "harness/sweep/store/row_hashes.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <string_view>

#include "datasets/core/error.hpp"
#include "datasets/core/parallel.hpp"

namespace loopbench::harness {
namespace {

/// Cells by id, and the hash of the rows of each.
struct HashedCells {
  std::span<StoredCell> cells;
  std::span<std::uint64_t> hashes;
};

/// Continues the hashes of the cells with their rows in the tables of traces, or in the others;
/// cells of which a score has no intact definition are marked.
void add_rows(Database& database,
              const HashedCells& all,
              bool of_traces,
              const std::vector<std::int64_t>& definitions) {
  const std::span<StoredCell> cells = all.cells;
  if (cells.empty()) return;
  for (const CellTable& table : kCellTables) {
    if (table.is_trace != of_traces) continue;
    const bool has_definitions = table.name == std::string_view(kScoreTable);
    std::size_t i = 0;
    const auto add = [&](const RowValues& row) {
      const std::int64_t id = row.integer(0);
      while (i < cells.size() && cells[i].id < id) ++i;
      if (i == cells.size() || cells[i].id != id) return;
      all.hashes[i] = row.hashed(all.hashes[i], 1);
      if (!has_definitions || !cells[i].intact) return;
      cells[i].intact = std::ranges::binary_search(definitions, row.integer(2));
    };
    database.for_each_row(table.name, cells.front().id, cells.back().id, add);
  }
}

/// The same by several threads, each with its own connection.
void add_rows_in_parts(Database& database,
                       const HashedCells& all,
                       bool of_traces,
                       const std::vector<std::int64_t>& definitions) {
  constexpr std::size_t kLeast = 1000;  // cells; fewer are not worth a connection
  const std::size_t count = all.cells.size();
  const std::size_t parts = std::clamp<std::size_t>(count / kLeast, 1, hardware_threads());
  parallel_invoke(parts, [&](std::size_t k) {
    const std::size_t begin = count * k / parts, size = count * (k + 1) / parts - begin;
    const HashedCells part{all.cells.subspan(begin, size), all.hashes.subspan(begin, size)};
    if (k == 0) return add_rows(database, part, of_traces, definitions);
    Database own(database.file(), Database::Mode::read);
    own.execute("PRAGMA busy_timeout = 0");
    add_rows(own, part, of_traces, definitions);
  });
}

}  // namespace

void check_rows(Database& database,
                std::vector<StoredCell>& cells,
                bool of_traces,
                const std::vector<std::uint64_t>& hashes) {
  const std::vector<std::int64_t> definitions = intact_definitions(database);
  std::vector<bool> before;
  for (const StoredCell& each : cells) before.push_back(each.intact);
  const auto check = [&](const auto& add) {
    std::vector<std::uint64_t> found = hashes;
    add(database, {cells, found}, of_traces, definitions);
    bool is_same = true;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::uint64_t stored = of_traces ? cells[i].trace_hash : cells[i].hash;
      cells[i].intact = cells[i].intact && stored == found[i];
      is_same = is_same && cells[i].intact == before[i];
    }
    return is_same;
  };
  try {
    if (check(add_rows_in_parts)) return;
  } catch (const InputError&) {
    // While a writer waits for this connection to end, no other one can read.
  }
  // Another connection also sees what a running sweep has written since this one began to read.
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i].intact = before[i];
  check(add_rows);
}

std::uint64_t with_rows(Database& database, std::uint64_t hash, std::int64_t id, bool of_trace) {
  for (const CellTable& table : kCellTables) {
    if (table.is_trace != of_trace) continue;
    Statement row = database.prepare(std::string("SELECT * FROM ") + table.name +
                                     " WHERE cell = ? ORDER BY 1, 2");
    row.bind(id);
    while (row.step()) hash = row.hashed(hash, 1);
  }
  return hash;
}

}  // namespace loopbench::harness
