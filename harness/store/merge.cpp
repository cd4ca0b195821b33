#include "harness/store/merge.hpp"

#include <map>
#include <set>
#include <tuple>

#include "datasets/core/error.hpp"
#include "harness/model/result.hpp"
#include "harness/store/cell_writer.hpp"
#include "harness/store/damage.hpp"
#include "harness/store/open.hpp"
#include "harness/store/rename_file.hpp"
#include "harness/store/write_digests.hpp"

namespace loopbench::harness {
namespace {

struct MergedCell {
  std::int64_t id = 0;
  std::int64_t position = 0;
  std::string key;
  std::string build;
  std::string sequence;
  std::int64_t repeat = 0;
  std::string method;
  bool failed = false;
};

constexpr const char* kCellColumns =
    "key, build, sequence_key, made, sequence, repeat, method, dataset_options, method_options, "
    "closures, "
    "oracle_closures, oracle, worker, runs, seconds_median, seconds_min, seconds_max, "
    "cpu_seconds_median, peak_memory, added_memory, allocations, status, signal, why, "
    "failed_scores, score_digest, phase_digest, count_digest, note_digest, section_digest, "
    "trace_digest";

/// The tables of a cell's rows, with their columns except `cell`.
constexpr std::pair<const char*, const char*> kDetails[] = {
    {"score",
     "protocol, protocol_version, times, metric, label, relation, axis, unit, better, target, "
     "count, rmse, mean, median, std, min, max, sse, pairs, possible, span, status, why"},
    {"phase", "name, seconds"},
    {"count", "name, value"},
    {"note", "text"},
    {"section", "kind, begin_stamp, end_stamp, what"},
    {"trace", "times, samples"}};

Database with_tables(const std::filesystem::path& file) {
  Database out(file, Database::Mode::create);
  create_tables(out);
  return out;
}

class Merge {
 public:
  Merge(const std::filesystem::path& file, bool mixed_builds)
      : database_(with_tables(file)), digests_(database_), mixed_builds_(mixed_builds) {}

  void add(const std::filesystem::path& store) {
    store_ = store_file(store).string();
    require_intact_store(store_);  // also recovers the log of a killed process
    database_.prepare("ATTACH ? AS source").bind(store_).run();
    {
      Transaction transaction(database_);
      for (MergedCell& cell : source_cells()) add(cell);
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
    return {known_.size(), twice_};
  }

 private:
  std::vector<MergedCell> source_cells() {
    Statement rows = database_.prepare(
        "SELECT id, position, key, build, sequence, repeat, method, status, failed_scores FROM "
        "source.cell WHERE position IS NOT NULL ORDER BY position");
    std::vector<MergedCell> out;
    while (rows.step()) {
      MergedCell& cell = out.emplace_back();
      cell.id = rows.integer();
      cell.position = rows.integer();
      cell.key = rows.text();
      cell.build = rows.text();
      cell.sequence = rows.text();
      cell.repeat = rows.integer();
      cell.method = rows.text();
      const Status status = from_text<Status>(rows.text()).value_or(Status::failed);
      cell.failed = rows.integer() > 0 || is_failure(status);
    }
    return out;
  }

  void add(MergedCell& cell) {
    if (build_.empty()) build_ = cell.build;
    if (cell.build != build_ && !mixed_builds_) {
      throw InputError(store_ + ": was computed by build " + cell.build +
                       ", the earlier stores by " + build_ + "; use --mixed-builds to merge them");
    }
    const Identity identity{cell.key, cell.sequence, cell.repeat, cell.method};
    if (const auto same = known_.find(identity); same != known_.end()) {
      ++twice_;
      if (!same->second.failed || cell.failed) return;
      remove_cell(database_, same->second.id);
      cell.position = same->second.position;
      cell.method = same->second.method;
      cell.id = copy(cell);
      same->second = cell;
      return;
    }
    const std::string method = cell.method;
    if (!labels_.emplace(cell.sequence, cell.repeat, cell.method).second) {
      cell.method += " (build " + cell.build.substr(0, 8) + ")";
      if (cell.build == build_ ||
          !labels_.emplace(cell.sequence, cell.repeat, cell.method).second) {
        throw InputError(
            store_ + ": " + cell.sequence + " / " + method +
            " is also in an earlier store, with different options, inputs or protocols");
      }
    }
    if (!positions_.insert(cell.position).second) {
      cell.position = *positions_.rbegin() + 1;
      positions_.insert(cell.position);
    }
    cell.id = copy(cell);
    known_.emplace(identity, cell);
  }

  std::int64_t copy(const MergedCell& cell) {
    const std::string columns = kCellColumns;
    database_
        .prepare("INSERT INTO main.cell (position, " + columns + ") SELECT ?, " + columns +
                 " FROM source.cell WHERE id = ?")
        .bind(cell.position)
        .bind(cell.id)
        .run();
    const std::int64_t id = database_.last_row();
    database_.prepare("UPDATE main.cell SET method = ? WHERE id = ?")
        .bind(cell.method)
        .bind(id)
        .run();
    digests_.update_cell(id);
    for (const auto& [table, fields] : kDetails) {
      const std::string name = table;
      const std::string list = fields;
      database_
          .prepare("INSERT INTO main." + name + " (cell, " + list + ") SELECT ?, " + list +
                   " FROM source." + name + " WHERE cell = ? ORDER BY rowid")
          .bind(id)
          .bind(cell.id)
          .run();
    }
    return id;
  }

  void add_sequences() {
    Statement other = database_.prepare(
        "SELECT s.path FROM source.input s JOIN source.sequence t USING (sequence_key) JOIN "
        "main.sequence n ON n.asked = t.asked JOIN main.input m ON m.sequence_key = n.sequence_key "
        "AND m.number = s.number WHERE s.hash <> m.hash AND t.sequence_key IN (SELECT sequence_key "
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
                        " WHERE sequence_key IN (SELECT sequence_key FROM main.cell) AND "
                        "sequence_key NOT IN (SELECT "
                        "sequence_key FROM main.sequence)");
    }
  }

  /// Different values are concatenated as lines; the baseline is that of the first store.
  void add_texts() {
    database_.execute(
        "INSERT INTO main.run SELECT key, value FROM source.run WHERE key <> 'exported' ON "
        "CONFLICT "
        "(key) DO UPDATE SET value = value || char(10) || excluded.value WHERE excluded.key <> "
        "'baseline' AND instr(char(10) || value || char(10), char(10) || excluded.value || "
        "char(10)) = 0");
    database_.execute(
        "INSERT OR IGNORE INTO main.provenance SELECT * FROM source.provenance WHERE made IN "
        "(SELECT made FROM main.cell)");
  }

  Database database_;
  DigestWriter digests_;
  bool mixed_builds_;
  std::string store_;  ///< the store being added
  std::string build_;  ///< of the first cell
  /// Original key and labels; two labels can have the same key.
  using Identity = std::tuple<std::string, std::string, std::int64_t, std::string>;
  std::map<Identity, MergedCell> known_;
  std::set<std::tuple<std::string, std::int64_t, std::string>> labels_;
  std::set<std::int64_t> positions_;
  std::size_t twice_ = 0;
};

}  // namespace

Merged merge_stores(const std::vector<std::filesystem::path>& stores,
                    const std::filesystem::path& out,
                    bool mixed_builds) {
  if (std::filesystem::exists(out)) {
    throw InputError(out.string() + ": already exists; merge writes a new store");
  }
  const std::filesystem::path partial = out.string() + ".partial";
  std::error_code none;
  if (out.has_parent_path()) std::filesystem::create_directories(out.parent_path(), none);
  remove_files_of(partial);
  try {
    Merged merged;
    {
      Merge merge(partial, mixed_builds);
      for (const std::filesystem::path& store : stores) merge.add(store);
      merged = merge.done();
    }
    require_intact_store(partial);  // detects rows that a damaged index did not find
    rename_file(partial, out);
    return merged;
  } catch (const std::filesystem::filesystem_error& error) {
    remove_files_of(partial);
    throw InputError(out.string() + ": cannot be written: " + error.code().message());
  } catch (...) {
    remove_files_of(partial);
    throw;
  }
}

}  // namespace loopbench::harness
