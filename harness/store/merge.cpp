#include "harness/store/merge.hpp"

#include <algorithm>
#include <future>
#include <optional>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>

#include "datasets/core/error.hpp"
#include "harness/model/recorded_run.hpp"
#include "harness/model/result.hpp"
#include "harness/store/cell_writer.hpp"
#include "harness/store/copy_rows.hpp"
#include "harness/store/damage.hpp"
#include "harness/store/folder_lock.hpp"
#include "harness/store/open.hpp"
#include "harness/store/plan.hpp"
#include "harness/store/rename_file.hpp"
#include "harness/text/hash.hpp"

namespace loopbench::harness {
namespace {

/// Durability comes from renaming the complete file.
Database with_tables(const std::filesystem::path& file) {
  Database out(file, Database::Mode::create);
  out.execute("PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF; PRAGMA cache_size = -65536");
  create_tables(out);
  return out;
}

/// A cell of the output.
struct KnownCell {
  std::int64_t id = 0;
  bool failed = false;
};

/// Identifies a cell by key, sequence, repeat and method, in 16 bytes.
Hash identity(const std::string& key, const StoredCell& cell) {
  Fields fields;
  fields.add(key)
      .add(cell.sequence.text())
      .add(cell.method.text())
      .add(std::to_string(cell.repeat));
  return hash_of(fields.hashed());
}

struct LowBits {
  std::size_t operator()(const Hash& hash) const { return hash.low; }
};

class Merge {
 public:
  Merge(const std::filesystem::path& file, bool mixed_builds)
      : database_(with_tables(file)), checksums_(database_), mixed_builds_(mixed_builds) {
    database_.execute("CREATE TEMP TABLE copied (id INTEGER PRIMARY KEY)");
  }

  /// `cells`: those of the store, all intact.
  void add(const std::filesystem::path& store, const std::vector<StoredCell>& cells) {
    store_ = store.string();
    database_.prepare("ATTACH ? AS source").bind(store_).run();
    {
      Transaction transaction(database_);
      check_recorded_options();
      check_inputs();
      copy_sequences(database_);
      add_cells(cells);
      copy_details(database_, offset_);
      copy_texts(database_);
      transaction.commit();
    }
    database_.execute("DETACH source");
  }

  Merged done() {
    database_.execute("INSERT OR REPLACE INTO run VALUES ('cells', (SELECT count(*) FROM cell))");
    Merged out;
    out.cells = known_.size();
    out.duplicates = twice_;
    const SweepPlan plan(run_value("plan"));
    out.planned = static_cast<std::size_t>(plan.size());
    for (std::int64_t position = 0; position < plan.size(); ++position) {
      if (positions_.contains(position)) continue;
      ++out.missing;
      if (out.missing <= kListedMissing) out.first_missing.push_back(plan.label(position));
    }
    Statement sets = database_.prepare(
        "SELECT DISTINCT value FROM provenance WHERE key = 'instructions' ORDER BY value");
    while (sets.step()) out.instruction_sets.push_back(sets.text());
    if (out.missing > 0) out.missing_shards = missing_shards(run_value("shard"));
    return out;
  }

 private:
  void add_cells(const std::vector<StoredCell>& cells) {
    const std::string columns = std::string(kCellColumns) + ", checksum, report_checksum";
    const std::string others = columns.substr(columns.find(", ") + 2);  // all but the position
    Statement insert =
        database_.prepare("INSERT INTO main.cell (id, position, " + others + ") SELECT ?, ?, " +
                          others + " FROM source.cell WHERE id = ?");
    Statement rename = database_.prepare("UPDATE main.cell SET method = ? WHERE id = ?");
    Statement copied = database_.prepare("INSERT INTO copied VALUES (?)");
    Statement last = database_.prepare("SELECT coalesce(max(id), 0) FROM main.cell");
    offset_ = last.step() ? last.integer() : 0;
    last.reset();
    database_.execute("DELETE FROM copied");
    for (const std::size_t i : in_order(cells)) {
      StoredCell cell = cells[i];
      if (!place(cell)) continue;
      insert.bind(offset_ + cell.id).bind(cell.position).bind(cell.id).run();
      const bool has_other_label = cell.method != cells[i].method;
      if (has_other_label) rename.bind(cell.method.text()).bind(offset_ + cell.id).run();
      if (has_other_label || cell.position != cells[i].position) {
        checksums_.update_row(offset_ + cell.id, cell.own);
      }
      copied.bind(cell.id).run();
    }
  }

  /// Gives the cell its position and label in the output; false if it is not copied.
  bool place(StoredCell& cell) {
    const bool has_failed = cell.failed_scores > 0 || is_failure(cell.status);
    if (build_.empty()) build_ = cell.build;
    if (cell.build != build_ && !mixed_builds_) {
      throw InputError(store_ + ": was computed by build " + cell.build +
                       ", the earlier stores by " + build_ + "; use --mixed-builds to merge them");
    }
    // Original key and labels, because two labels can have the same key.
    const auto [same, is_new] = known_.try_emplace(identity(cell.key, cell));
    if (!is_new) {
      ++twice_;
      if (!same->second.failed || has_failed) return false;
      replace(cell, same->second);
      same->second = {offset_ + cell.id, has_failed};
      return true;
    }
    const std::string method = cell.method;
    const auto is_free = [&] { return labels_.insert(identity("", cell)).second; };
    if (!is_free()) {
      cell.method = cell.method + " (build " + cell.build.text().substr(0, 8) + ")";
      if (cell.build == build_ || !is_free()) {
        throw InputError(
            store_ + ": " + cell.sequence + " / " + method +
            " is also in an earlier store, with different options, inputs or protocols");
      }
    }
    if (!positions_.insert(cell.position).second) {
      cell.position = last_position_ + 1;
      positions_.insert(cell.position);
    }
    last_position_ = std::max(last_position_, cell.position);
    same->second = {offset_ + cell.id, has_failed};
    return true;
  }

  /// A cell takes the position and label of an earlier one that failed.
  void replace(StoredCell& cell, const KnownCell& failed) {
    Statement row = database_.prepare("SELECT position, method FROM main.cell WHERE id = ?");
    if (!row.bind(failed.id).step()) throw std::logic_error("merge: a copied cell is not there");
    cell.position = row.integer();
    cell.method = row.text();
    row.reset();
    remove_cell(database_, failed.id);
    database_.prepare("DELETE FROM copied WHERE id = ?").bind(failed.id - offset_).run();
  }

  void check_recorded_options() {
    const std::string added = run_value("config", "source.run");
    const std::string why = why_other_options(run_value("config"), added);
    if (!why.empty()) throw InputError(store_ + ": " + why);
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

  std::string run_value(const std::string& key, const std::string& table = "main.run") {
    Statement row = database_.prepare("SELECT value FROM " + table + " WHERE key = ?");
    return row.bind(key).step() ? row.text() : "";
  }

  Database database_;
  ChecksumWriter checksums_;
  bool mixed_builds_;
  std::string store_;        ///< the store being added
  std::int64_t offset_ = 0;  ///< from the ids of its cells to those of the output
  std::string build_;        ///< of the first cell
  std::unordered_map<Hash, KnownCell, LowBits> known_;
  std::unordered_set<Hash, LowBits> labels_;
  std::unordered_set<std::int64_t> positions_;
  std::int64_t last_position_ = -1;
  std::size_t twice_ = 0;
};

/// All cells, checked with their traces; recovers the log of a killed process. Throws InputError.
std::vector<StoredCell> intact_cells(const std::filesystem::path& store) {
  Database database = open_store(store);
  std::vector<StoredCell> out = checked_cells(database, true);
  require_intact(database, out);
  return out;
}

/// Adds all stores. Each is checked while the one before it is copied.
Merged merge_all(const std::vector<std::filesystem::path>& stores,
                 const std::filesystem::path& partial,
                 bool mixed_builds) {
  Merge merge(partial, mixed_builds);
  const auto checked = [&](std::size_t i) {
    return std::async(std::launch::async, intact_cells, stores[i]);
  };
  std::future<std::vector<StoredCell>> next = checked(0);
  for (std::size_t i = 0; i < stores.size(); ++i) {
    const std::vector<StoredCell> cells = next.get();
    if (i + 1 < stores.size()) next = checked(i + 1);
    merge.add(store_file(stores[i]), cells);
  }
  return merge.done();
}

}  // namespace

Merged merge_stores(const std::vector<std::filesystem::path>& stores,
                    const std::filesystem::path& out,
                    const MergeOptions& options) {
  std::vector<std::filesystem::path> all = stores;
  std::optional<FolderLock> lock;
  if (std::filesystem::exists(out)) {
    if (!options.add) {
      throw InputError(out.string() +
                       ": already exists; merge writes a new store, or adds to it with --add");
    }
    lock.emplace(out.has_parent_path() ? out.parent_path() : ".");
    all.insert(all.begin(), out);
  }
  const std::filesystem::path partial = out.string() + ".partial";
  std::error_code none;
  if (out.has_parent_path()) std::filesystem::create_directories(out.parent_path(), none);
  remove_files_of(partial);
  try {
    const Merged result = merge_all(all, partial, options.mixed_builds);
    rename_file(partial, out);
    return result;
  } catch (const std::filesystem::filesystem_error& error) {
    remove_files_of(partial);
    throw InputError(out.string() + ": cannot be written: " + error.code().message());
  } catch (...) {
    remove_files_of(partial);
    throw;
  }
}

}  // namespace loopbench::harness
