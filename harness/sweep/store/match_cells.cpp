#include "harness/sweep/store/match_cells.hpp"

#include <algorithm>
#include <map>
#include <unordered_map>

#include "harness/sweep/store/stored_cells.hpp"

namespace loopbench::harness {
namespace {

using Inputs = std::vector<InputFile>;

/// The input files of every stored sequence, by its configuration: a store can hold several
/// versions of a sequence, each with its own files.
std::map<std::string, std::vector<Inputs>> stored_inputs(Database& database) {
  std::map<std::string, std::vector<Inputs>> out;
  Statement row = database.prepare(
      "SELECT configuration_hash, sequence_key, option IS NOT NULL, option, path, bytes, hash FROM "
      "sequence LEFT JOIN input USING (sequence_key) ORDER BY sequence_key, number");
  std::string last;
  while (row.step()) {
    std::string configuration_hash, sequence_key;
    bool has_file = false;
    InputFile file;
    row.read(configuration_hash, sequence_key, has_file);
    row.read(file.option, file.path, file.bytes, file.hash);
    std::vector<Inputs>& versions = out[configuration_hash];
    if (sequence_key != last) versions.emplace_back();
    if (has_file) versions.back().push_back(file);
    last = sequence_key;
  }
  return out;
}

/// The current inputs of a cell's sequence, from the version that matches the files now, or
/// otherwise any.
Inputs inputs_now(const std::vector<Inputs>& versions, CellKeys& keys, const Cell& cell) {
  Inputs now;
  for (const Inputs& stored : versions) {
    now = keys.current_inputs(cell, stored);
    if (std::ranges::equal(now, stored, {}, &InputFile::hash, &InputFile::hash)) break;
  }
  return now;
}

/// The key of every cell with the current inputs.
std::vector<std::string> keys_now(Database& database,
                                  CellKeys& keys,
                                  const std::vector<Cell>& all) {
  std::map<std::string, std::vector<Inputs>> known = stored_inputs(database);
  std::map<std::string, Inputs> inputs;
  std::vector<std::string> out;
  out.reserve(all.size());
  for (const Cell& cell : all) {
    const std::string& configuration_hash = keys.configuration_hash(cell);
    const auto [entry, is_new] = inputs.try_emplace(configuration_hash);
    if (is_new) entry->second = inputs_now(known[configuration_hash], keys, cell);
    out.push_back(keys.key(cell, entry->second));
  }
  return out;
}

bool same_labels(const StoredCell& row, const Cell& cell, const Sweep& sweep) {
  return row.sequence == sweep.datasets[cell.dataset].label && row.repeat == cell.repeat &&
         row.method == sweep.methods[cell.method].label;
}

bool has_failed(const StoredCell& row) { return is_failure(row.status) || row.failed_scores > 0; }

/// For each cell the stored cell with its key, by preference with its labels, or null. No stored
/// cell is returned twice.
std::vector<const StoredCell*> claim(const std::vector<StoredCell>& stored,
                                     Database& database,
                                     CellKeys& keys,
                                     const std::vector<Cell>& all) {
  const std::vector<std::string> wanted = keys_now(database, keys, all);
  std::unordered_multimap<std::string_view, const StoredCell*> free;
  for (const StoredCell& row : stored) free.emplace(row.key, &row);
  std::vector<const StoredCell*> out(all.size(), nullptr);
  for (const bool exact : {true, false}) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (out[i] != nullptr) continue;
      auto [found, end] = free.equal_range(wanted[i]);
      while (found != end && exact && !same_labels(*found->second, all[i], keys.sweep())) ++found;
      if (found == end) continue;
      out[i] = found->second;
      free.erase(found);
    }
  }
  return out;
}

}  // namespace

Resumed match_cells(Database& database,
                    const std::vector<StoredCell>& stored,
                    CellKeys& keys,
                    const std::vector<Cell>& all,
                    const std::vector<Cell>& planned,
                    Retry retry) {
  const Sweep& sweep = keys.sweep();
  const std::vector<const StoredCell*> claimed = claim(stored, database, keys, all);

  Resumed out;
  out.unchanged = true;
  Statement set_aside = database.prepare("UPDATE cell SET position = NULL WHERE id = ?");
  std::vector<const StoredCell*> in_use = claimed;
  std::ranges::sort(in_use);
  for (const StoredCell& row : stored) {
    if (!row.placed || std::ranges::binary_search(in_use, &row)) continue;
    set_aside.bind(row.id).run();
    set_hashes(database, row.id);
    out.unchanged = false;
  }
  Statement entry = database.prepare(
      "UPDATE cell SET position = ?, sequence = ?, repeat = ?, method = ? WHERE id = ?");
  std::unordered_map<std::size_t, const StoredCell*> by_index;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const StoredCell* row = claimed[i];
    if (row == nullptr) {
      out.unchanged = false;
      continue;
    }
    const Cell& cell = all[i];
    by_index.emplace(cell.index, row);
    const bool same_position =
        row->placed && row->position == static_cast<std::int64_t>(cell.index);
    if (same_position && same_labels(*row, cell, sweep)) continue;
    out.unchanged = false;
    entry.bind(cell.index, sweep.datasets[cell.dataset].label, cell.repeat)
        .bind(sweep.methods[cell.method].label, row->id)
        .run();
    set_hashes(database, row->id);
  }
  for (const Cell& cell : planned) {
    const auto found = by_index.find(cell.index);
    const StoredCell* row = found == by_index.end() ? nullptr : found->second;
    const bool again =
        row != nullptr && (retry == Retry::all || (retry == Retry::failed && has_failed(*row)));
    if (row == nullptr || again) {
      out.missing.push_back(cell);
      continue;
    }
    ++out.there;
    if (has_failed(*row)) ++out.failed;
    if (row->status == Status::incomplete) ++out.incomplete;
  }
  return out;
}

std::vector<Cell> missing_cells(const std::filesystem::path& store,
                                CellKeys& keys,
                                const std::vector<Cell>& all,
                                const std::vector<Cell>& planned) {
  const std::filesystem::path file = store_file(store);
  Database database(file, Database::Mode::read);
  check_schema(database, file);
  database.execute("BEGIN");
  std::vector<StoredCell> stored = read_stored_cells(database);
  check_traces(database, stored);
  std::erase_if(stored, [](const StoredCell& cell) { return !cell.intact; });
  const std::vector<const StoredCell*> claimed = claim(stored, database, keys, all);
  std::vector<Cell> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_planned = std::ranges::binary_search(planned, all[i].index, {}, &Cell::index);
    if (claimed[i] == nullptr && is_planned) out.push_back(all[i]);
  }
  return out;
}

}  // namespace loopbench::harness
