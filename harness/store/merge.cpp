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
#include "harness/store/cell_columns.hpp"
#include "harness/store/cell_writer.hpp"
#include "harness/store/damage.hpp"
#include "harness/store/folder_lock.hpp"
#include "harness/store/merged_cell.hpp"
#include "harness/store/open.hpp"
#include "harness/store/plan.hpp"
#include "harness/store/rename_file.hpp"
#include "harness/store/score_rows.hpp"
#include "harness/store/write_digests.hpp"

namespace loopbench::harness {
namespace {

Database with_tables(const std::filesystem::path& file) {
  Database out(file, Database::Mode::create);
  create_tables(out);
  return out;
}

class Merge {
 public:
  Merge(const std::filesystem::path& file, bool mixed_builds)
      : database_(with_tables(file)), digests_(database_), mixed_builds_(mixed_builds) {
    database_.execute("CREATE TEMP TABLE copied (id INTEGER PRIMARY KEY)");
  }

  /// `store`: an intact file.
  void add(const std::filesystem::path& store) {
    store_ = store.string();
    database_.prepare("ATTACH ? AS source").bind(store_).run();
    {
      Transaction transaction(database_);
      check_recorded_options();
      add_cells();
      add_details();
      add_sequences();
      add_texts();
      transaction.commit();
    }
    database_.execute("DETACH source");
  }

  Merged done() {
    Transaction transaction(database_);
    for (const char* table : {"cell", "sequence"}) update_sum(database_, table);
    for (const char* table : {"run", "provenance"}) update_texts(database_, table);
    transaction.commit();
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
  void add_cells() {
    // Not by an index, which can be damaged and miss rows.
    Statement rows = database_.prepare(
        "SELECT id, position, key, build, sequence, repeat, method, status, failed_scores FROM "
        "source.cell NOT INDEXED WHERE position IS NOT NULL ORDER BY position");
    const std::string columns = kCellColumns;
    Statement insert =
        database_.prepare("INSERT INTO main.cell (id, position, " + columns + ") SELECT ?, ?, " +
                          columns + " FROM source.cell WHERE id = ?");
    Statement copied = database_.prepare("INSERT INTO copied VALUES (?)");
    Statement last = database_.prepare("SELECT coalesce(max(id), 0) FROM main.cell");
    offset_ = last.step() ? last.integer() : 0;
    last.reset();
    database_.execute("DELETE FROM copied");
    MergedCell cell;
    while (rows.step()) {
      cell.id = rows.integer();
      cell.position = rows.integer();
      cell.key = rows.text();
      cell.build = rows.text();
      cell.sequence = rows.text();
      cell.repeat = rows.integer();
      cell.method = rows.text();
      const Status status = from_text<Status>(rows.text()).value_or(Status::failed);
      cell.failed = rows.integer() > 0 || is_failure(status);
      const std::string method = cell.method;
      if (!place(cell)) continue;
      insert.bind(offset_ + cell.id).bind(cell.position).bind(cell.id).run();
      if (cell.method != method) rename(offset_ + cell.id, cell.method);
      digests_.update_cell(offset_ + cell.id);
      copied.bind(cell.id).run();
    }
  }

  /// Gives the cell its position and label in the output; false if it is not copied.
  bool place(MergedCell& cell) {
    if (build_.empty()) build_ = cell.build;
    if (cell.build != build_ && !mixed_builds_) {
      throw InputError(store_ + ": was computed by build " + cell.build +
                       ", the earlier stores by " + build_ + "; use --mixed-builds to merge them");
    }
    // Original key and labels, because two labels can have the same key.
    const auto [same, is_new] =
        known_.try_emplace(hash_of_fields({cell.key, cell.sequence, cell.method}, cell.repeat));
    if (!is_new) {
      ++twice_;
      if (!same->second.failed || cell.failed) return false;
      replace(cell, same->second);
      return true;
    }
    const std::string method = cell.method;
    const auto is_free = [&] {
      return labels_.insert(hash_of_fields({cell.sequence, cell.method}, cell.repeat)).second;
    };
    if (!is_free()) {
      cell.method += " (build " + cell.build.substr(0, 8) + ")";
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
    same->second = {offset_ + cell.id, cell.failed};
    return true;
  }

  /// A cell takes the position and label of an earlier one that failed.
  void replace(MergedCell& cell, KnownCell& failed) {
    Statement row = database_.prepare("SELECT position, method FROM main.cell WHERE id = ?");
    if (!row.bind(failed.id).step()) throw std::logic_error("merge: a copied cell is not there");
    cell.position = row.integer();
    cell.method = row.text();
    row.reset();
    remove_cell(database_, failed.id);
    database_.prepare("DELETE FROM copied WHERE id = ?").bind(failed.id - offset_).run();
    failed = {offset_ + cell.id, cell.failed};
  }

  void rename(std::int64_t id, const std::string& method) {
    database_.prepare("UPDATE main.cell SET method = ? WHERE id = ?").bind(method).bind(id).run();
  }

  void add_details() {
    copy_scores(database_, offset_);
    for (const auto& [table, fields] : kDetails) {
      const std::string name = table;
      const std::string list = fields;
      database_
          .prepare("INSERT INTO main." + name + " (cell, " + list + ") SELECT cell + ?, " + list +
                   " FROM source." + name + " NOT INDEXED WHERE cell IN copied ORDER BY rowid")
          .bind(offset_)
          .run();
    }
  }

  void check_recorded_options() {
    const std::string added = run_value("config", "source.run");
    const std::string why = why_other_options(run_value("config"), added);
    if (!why.empty()) throw InputError(store_ + ": " + why);
  }

  std::string run_value(const std::string& key, const std::string& table = "main.run") {
    Statement row = database_.prepare("SELECT value FROM " + table + " WHERE key = ?");
    return row.bind(key).step() ? row.text() : "";
  }

  void add_sequences() {
    Statement other = database_.prepare(
        "SELECT s.path FROM source.input s JOIN source.sequence t USING (sequence_key) JOIN "
        "main.sequence n USING (configuration_hash) JOIN main.input m ON m.sequence_key = "
        "n.sequence_key AND m.number = s.number WHERE s.hash <> m.hash AND t.sequence_key IN "
        "(SELECT sequence_key "
        "FROM source.cell WHERE position IS NOT NULL) LIMIT 1");
    if (other.step()) {
      throw InputError(store_ + ": was computed from a different " + other.text() +
                       " than the earlier stores");
    }
    other.reset();
    // Copied completely from one store, because of the digests; preferably with a trace.
    for (const char* table : {"input", "sequence"}) {
      database_.execute(
          "DELETE FROM main." + std::string(table) +
          " WHERE sequence_key IN (SELECT m.sequence_key FROM main.sequence m JOIN "
          "source.sequence s ON s.sequence_key = m.sequence_key WHERE m.trace_digest = '' AND "
          "s.trace_digest <> '')");
    }
    for (const char* table : {"input", "sequence_trace", "sequence"}) {
      const std::string name = table;
      database_.execute("INSERT INTO main." + name + " SELECT * FROM source." + name +
                        " WHERE sequence_key IN (SELECT sequence_key FROM source.cell WHERE "
                        "position IS NOT NULL) AND sequence_key NOT IN (SELECT sequence_key FROM "
                        "main.sequence)");
    }
  }

  /// Different values are concatenated as lines; the baseline is that of the first store, and
  /// stores with different plans have none.
  void add_texts() {
    database_.execute(
        "INSERT INTO main.run SELECT key, value FROM source.run WHERE key <> 'exported' ON "
        "CONFLICT (key) DO UPDATE SET value = CASE WHEN key = 'plan' THEN '' ELSE value || "
        "char(10) || excluded.value END WHERE key <> 'baseline' AND instr(char(10) || value || "
        "char(10), char(10) || excluded.value || char(10)) = 0");
    database_.execute(
        "INSERT OR IGNORE INTO main.provenance SELECT * FROM source.provenance WHERE "
        "provenance_key IN (SELECT provenance_key FROM source.cell WHERE id IN copied)");
  }

  Database database_;
  DigestWriter digests_;
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

/// Adds all stores. Each is checked completely while the one before it is copied; the check also
/// recovers the log of a killed process.
Merged merge_all(const std::vector<std::filesystem::path>& stores,
                 const std::filesystem::path& partial,
                 bool mixed_builds) {
  Merge merge(partial, mixed_builds);
  const auto checked = [&](std::size_t i) {
    return std::async(std::launch::async, require_intact_store, store_file(stores[i]));
  };
  std::future<void> next = checked(0);
  for (std::size_t i = 0; i < stores.size(); ++i) {
    next.get();
    if (i + 1 < stores.size()) next = checked(i + 1);
    merge.add(store_file(stores[i]));
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
    require_intact_store(partial);
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
