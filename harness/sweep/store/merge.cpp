#include "harness/sweep/store/merge.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "datasets/core/error.hpp"
#include "harness/sweep/model/evaluated_run.hpp"
#include "harness/sweep/store/merge_trajectories.hpp"
#include "harness/sweep/store/open.hpp"
#include "harness/sweep/store/schema.hpp"
#include "harness/sweep/store/shard.hpp"
#include "harness/sweep/store/stored_cells.hpp"

namespace loopbench::harness {
namespace {

/// The shards that are missing in `lines` "3/8 DIVISION", of divisions that others belong to.
std::vector<std::string> missing_shards(const std::string& lines) {
  std::map<std::pair<std::size_t, std::string>, std::set<std::size_t>> found;
  std::istringstream in(lines);
  for (std::string name, division; in >> name >> division;) {
    const Shard shard = parse_shard(name);
    found[{shard.count, division}].insert(shard.number);
  }
  std::vector<std::string> out;
  for (const auto& [division, numbers] : found) {
    for (Shard each{1, division.first}; each.number <= each.count; ++each.number) {
      if (!numbers.contains(each.number)) out.push_back(each.name());
    }
  }
  return out;
}

/// Copies stores one after the other, attached as `source`, into the new store `main`.
class Merge {
 public:
  Merge(const std::filesystem::path& file, bool mixed_builds)
      : database_(file, Database::Mode::create), mixed_builds_(mixed_builds) {
    // Durability comes from renaming the complete file.
    database_.execute(
        "PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF; PRAGMA cache_size = -65536");
    create_tables(database_);
    // The cells of `main`, and those to be added.
    database_.execute(
        "CREATE TEMP TABLE known (id INTEGER PRIMARY KEY, key TEXT, sequence TEXT, repeat INTEGER, "
        "method TEXT, failed INTEGER); "
        "CREATE INDEX known_label ON known(sequence, repeat, method); "
        "CREATE TEMP TABLE added (id INTEGER PRIMARY KEY, place INTEGER, failed INTEGER, replaced "
        "INTEGER)");
  }

  void add(const std::filesystem::path& store) {
    store_ = store.string();
    require_intact_file(store);
    database_.prepare("ATTACH ? AS source").bind(store_).run();
    {
      Transaction transaction(database_);
      check_evaluated_options();
      check_shard();
      check_builds();
      check_inputs();
      list_cells();
      replace_failed();
      check_labels();
      choose_positions();
      copy_cells();
      copy_descriptions();
      transaction.commit();
    }
    database_.execute("DETACH source");
  }

  Merged done() {
    Merged out;
    out.cells = static_cast<std::size_t>(database_.integer("SELECT count(*) FROM cell"));
    set_run_value(database_, "cells", std::to_string(out.cells));
    out.duplicates = duplicates_;
    const std::int64_t planned =
        database_.integer("SELECT CAST(value AS INTEGER) FROM run WHERE key = 'planned'");
    const std::int64_t there =
        database_.integer("SELECT count(*) FROM cell WHERE position < " + std::to_string(planned));
    out.planned = static_cast<std::size_t>(planned);
    out.missing = static_cast<std::size_t>(std::max<std::int64_t>(0, planned - there));
    Statement sets = database_.prepare(
        "SELECT DISTINCT value FROM provenance WHERE key = 'instructions' ORDER BY value");
    while (sets.step()) out.instruction_sets.push_back(sets.text());
    if (out.missing > 0) out.missing_shards = missing_shards(run_value("shard"));
    return out;
  }

 private:
  /// Also recovers the log of a killed process.
  static void require_intact_file(const std::filesystem::path& store) {
    Database database = open_store(store);
    require_intact(database);
  }

  void check_evaluated_options() {
    const std::string added = run_value("config", "source.run");
    const std::string why = why_other_options(run_value("config"), added);
    if (!why.empty()) throw InputError(store_ + ": " + why);
  }

  /// Shards are parts of one sweep; other stores can have different configs.
  void check_shard() {
    if (run_value("shard").empty() || run_value("shard", "source.run").empty()) return;
    if (run_value("config") == run_value("config", "source.run")) return;
    throw InputError(store_ +
                     ": is a shard of a different config than the earlier stores; run all shards "
                     "with the same file");
  }

  void check_builds() {
    Statement row =
        database_.prepare("SELECT DISTINCT build FROM source.cell WHERE position IS NOT NULL");
    while (row.step()) {
      const std::string build = row.text();
      if (build_.empty()) build_ = build;
      if (build == build_ || mixed_builds_) continue;
      throw InputError(store_ + ": was computed by build " + build + ", the earlier stores by " +
                       build_ + "; use --mixed-builds to merge them");
    }
  }

  /// Throws InputError if a sequence was read from other files than in the earlier stores.
  void check_inputs() {
    Statement other = database_.prepare(
        "SELECT s.path FROM source.input s JOIN source.sequence t USING (sequence_key) JOIN "
        "main.sequence n USING (configuration_hash) JOIN main.input m ON m.sequence_key = "
        "n.sequence_key AND m.number = s.number WHERE s.hash <> m.hash AND t.sequence_key IN "
        "(SELECT sequence_key FROM source.cell WHERE position IS NOT NULL) LIMIT 1");
    if (!other.step()) return;
    throw InputError(store_ + ": was computed from a different " + other.text() +
                     " than the earlier stores");
  }

  /// Fills `added` with the cells of the store's config, except those that `main` has. A known cell
  /// has the same key and, because two labels can have the same key, the same labels.
  void list_cells() {
    database_.execute(
        "DELETE FROM added; "
        "INSERT INTO added SELECT s.id, s.position, s.failed_scores > 0 OR s.status IN "
        "('failed', 'crashed', 'timeout', 'out_of_memory'), "
        "k.id FROM source.cell s LEFT JOIN known k ON k.key = s.key AND k.sequence = s.sequence "
        "AND k.repeat = s.repeat AND k.method = s.method WHERE s.position IS NOT NULL");
    duplicates_ += static_cast<std::size_t>(
        database_.integer("SELECT count(*) FROM added WHERE replaced IS NOT NULL"));
    database_.execute(
        "DELETE FROM added WHERE replaced IS NOT NULL AND (failed OR NOT (SELECT failed FROM known "
        "WHERE id = replaced))");
  }

  /// A cell takes the position of an earlier one that failed.
  void replace_failed() {
    database_.execute("UPDATE added SET place = c.position FROM main.cell c WHERE c.id = replaced");
    std::vector<std::int64_t> failed;
    Statement row = database_.prepare("SELECT replaced FROM added WHERE replaced IS NOT NULL");
    while (row.step()) failed.push_back(row.integer());
    for (const std::int64_t id : failed) {
      remove_cell(database_, id);
      database_.prepare("DELETE FROM known WHERE id = ?").bind(id).run();
    }
  }

  void check_labels() {
    Statement row = database_.prepare(
        "SELECT s.sequence, s.method FROM added JOIN source.cell s USING (id) JOIN known k ON "
        "k.sequence = s.sequence AND k.repeat = s.repeat AND k.method = s.method");
    if (!row.step()) return;
    const std::string sequence = row.text();
    throw InputError(store_ + ": " + sequence + " / " + row.text() +
                     " is also in an earlier store, with different options, inputs, protocols or "
                     "builds");
  }

  /// Cells keep their positions where these are free; the others come after all of them.
  void choose_positions() {
    database_.execute(
        "UPDATE added SET place = new.place FROM (SELECT id, row_number() OVER (ORDER BY place) + "
        "max((SELECT max(place) FROM added), (SELECT max(position) FROM main.cell)) AS place FROM "
        "added WHERE replaced IS NULL AND place IN (SELECT position FROM main.cell)) AS new WHERE "
        "new.id = added.id");
  }

  void copy_cells() {
    const std::string offset =
        std::to_string(database_.integer("SELECT coalesce(max(id), 0) FROM main.cell")) + " + ";
    std::string columns = kCellColumns;  // with the new position
    columns.replace(columns.find("position"), 8, "place");
    for (const char* table : {"input", "sequence_trace", "sequence"}) {
      const std::string name = table;
      database_.execute("INSERT OR IGNORE INTO main." + name + " SELECT * FROM source." + name +
                        " WHERE sequence_key IN (SELECT sequence_key FROM source.cell WHERE "
                        "position IS NOT NULL)");
    }
    database_.execute(
        "INSERT OR IGNORE INTO main.sequence_note SELECT * FROM source.sequence_note WHERE "
        "notes_key "
        "IN (SELECT notes_key FROM source.cell WHERE position IS NOT NULL)");
    const std::string rows = "added JOIN source.cell AS cell USING (id)";
    database_.execute("INSERT INTO main.cell SELECT " + offset + "id, " + columns + ", hash FROM " +
                      rows + " ORDER BY id");
    database_.execute("INSERT INTO known SELECT " + offset +
                      "id, key, cell.sequence, cell.repeat, cell.method, failed FROM " + rows +
                      " ORDER BY id");
    for (const CellTable& table : kCellTables) {
      const std::string name = table.name;
      database_.execute("INSERT INTO main." + name + " SELECT " + offset +
                        database_.columns_of(name) + " FROM source." + name +
                        " WHERE cell IN (SELECT id FROM added) ORDER BY cell");
    }
    Statement moved =
        database_.prepare("SELECT " + offset + "id FROM " + rows + " WHERE place <> position");
    while (moved.step()) set_hashes(database_, moved.integer());
    database_.execute(
        "INSERT OR IGNORE INTO main.score_definition SELECT * FROM source.score_definition");
  }

  /// The table run, and provenance of the cells. Different values of run are concatenated as lines;
  /// the baseline is that of the first store, and stores of different sizes have no planned number.
  void copy_descriptions() {
    database_.execute(
        "INSERT INTO main.run SELECT key, value, 0 FROM source.run WHERE key <> 'cells' "
        "ON CONFLICT (key) DO UPDATE SET value = CASE WHEN key = 'planned' THEN '' ELSE "
        "value || char(10) || excluded.value END WHERE key <> 'baseline' AND instr(char(10) || "
        "value || char(10), char(10) || excluded.value || char(10)) = 0; "
        "INSERT OR IGNORE INTO main.provenance SELECT * FROM source.provenance WHERE "
        "provenance_key IN (SELECT provenance_key FROM source.cell WHERE id IN (SELECT id FROM "
        "added))");
    std::map<std::string, std::string> values;
    Statement row = database_.prepare("SELECT key, value FROM main.run");
    while (row.step()) {
      const std::string key = row.text();
      values[key] = row.text();
    }
    for (const auto& [key, value] : values) set_run_value(database_, key, value);
  }

  std::string run_value(const std::string& key, const std::string& table = "main.run") {
    Statement row = database_.prepare("SELECT value FROM " + table + " WHERE key = ?");
    return row.bind(key).step() ? row.text() : "";
  }

  Database database_;
  bool mixed_builds_;
  std::string store_;  ///< the store being added
  std::string build_;  ///< of the first cell
  std::size_t duplicates_ = 0;
};

Merged merge_all(const std::vector<std::filesystem::path>& stores,
                 const std::filesystem::path& partial,
                 bool mixed_builds) {
  Merge merge(partial, mixed_builds);
  for (const std::filesystem::path& store : stores) merge.add(store_file(store));
  return merge.done();
}

}  // namespace

Merged merge_stores(const std::vector<std::filesystem::path>& stores,
                    const std::filesystem::path& out,
                    const MergeOptions& options) {
  std::vector<std::filesystem::path> all = stores;
  const FolderLock lock(folder_of(out));
  const bool is_there = std::filesystem::exists(out);
  if (is_there && !options.add) {
    throw InputError(out.string() +
                     ": already exists; merge writes a new store, or adds to it with --add");
  }
  if (is_there) all.insert(all.begin(), out);
  const std::filesystem::path partial = out.string() + ".partial";
  remove_database(partial);
  try {
    const Merged result = merge_all(all, partial, options.mixed_builds);
    merge_trajectories(all, partial, folder_of(out) / "trajectories");
    if (is_there) include_log(out);
    rename_durably(partial, out);
    return result;
  } catch (const std::filesystem::filesystem_error& error) {
    remove_database(partial);
    throw InputError(out.string() + ": cannot be written: " + error.code().message());
  } catch (...) {
    remove_database(partial);
    throw;
  }
}

}  // namespace loopbench::harness
