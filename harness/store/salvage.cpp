#include "harness/store/salvage.hpp"

#include <map>
#include <set>

#include "datasets/core/error.hpp"
#include "harness/store/damage.hpp"
#include "harness/store/digest.hpp"
#include "harness/store/folder_lock.hpp"
#include "harness/store/open.hpp"
#include "harness/store/provenance_key.hpp"
#include "harness/store/rename_file.hpp"
#include "harness/store/salvage_rows.hpp"
#include "harness/store/write_digests.hpp"

namespace loopbench::harness {
namespace {

/// What one view of the damaged store contains.
struct Found {
  std::map<std::int64_t, std::string> cells;  ///< labels by id, of damaged cells too
  std::set<std::string> traces;               ///< dataset options of sequences without their trace
  std::int64_t nameless = 0;
  bool complete = false;  ///< `cells` has every cell that was written
};

std::int64_t count(Database& database, const std::string& sql) {
  Statement row = database.prepare(sql);
  return row.step() ? row.integer() : 0;
}

/// Keeps the cells of sequences of which only the trace is lost.
std::set<std::string> remove_damaged_traces(Database& database) {
  std::map<std::string, std::string> digests;
  {
    Statement rows = database.prepare("SELECT * FROM sequence_trace");
    while (rows.step()) {
      const std::string digest = digest_of_columns(rows, 1, rows.columns());
      digests[rows.text()] = digest;
    }
  }
  std::set<std::string> out;
  DigestWriter writer(database);
  for (const auto& [sequence_key, sequence] : read_sequence_rows(database).by_key) {
    if (!sequence.intact || digests[sequence_key] == sequence.trace_digest) continue;
    database.prepare("DELETE FROM sequence_trace WHERE sequence_key = ?").bind(sequence_key).run();
    writer.add_sequence(sequence_key);
    out.insert(sequence.options);
  }
  return out;
}

/// Removes rows of incomplete provenance, and the description of the run if it is damaged.
void check_texts(Database& database) {
  std::map<std::string, std::map<std::string, std::string>> all;
  {
    Statement rows = database.prepare("SELECT provenance_key, key, value FROM provenance");
    while (rows.step()) {
      const std::string provenance_key = rows.text();
      const std::string key = rows.text();
      all[provenance_key][key] = rows.text();
    }
  }
  for (const auto& [provenance_key, provenance] : all) {
    if (key_of_provenance(provenance) == provenance_key) continue;
    database.prepare("DELETE FROM provenance WHERE provenance_key = ?").bind(provenance_key).run();
  }
  if (digest_of_texts(database, "run") != written_digest(database, "run")) {
    database.execute("DELETE FROM run");
  }
  for (const char* table : {"run", "provenance"}) update_texts(database, table);
}

/// Keeps the cells of which only the phases are damaged, without them.
void remove_damaged_phases(Database& database, CellRows& rows) {
  std::vector<const CellRow*> intact;
  for (const CellRow& cell : rows.cells) {
    if (cell.intact) intact.push_back(&cell);
  }
  read_details(database, "phase", rows);
  Statement phases = database.prepare("DELETE FROM phase WHERE cell = ?");
  Statement digest = database.prepare("UPDATE cell SET phase_digest = '' WHERE id = ?");
  DigestWriter writer(database);
  for (const CellRow* cell : intact) {
    if (cell->intact) continue;
    phases.bind(cell->id).run();
    digest.bind(cell->id).run();
    writer.update_cell(cell->id);
  }
}

/// Whether a cell without its phases counts as intact.
enum class Phases { required, optional };

/// Writes the intact cells of `view` into the new store `file`.
Found write_view(const PageFile& damaged,
                 const PageView& view,
                 const std::filesystem::path& file,
                 Phases phases) {
  Database database(file, Database::Mode::create);
  create_tables(database);
  Transaction transaction(database);
  insert_rows(database, damaged, view);
  Found out;
  out.nameless = count(
      database,
      "SELECT count(*) FROM (SELECT cell FROM scores UNION SELECT cell FROM phase UNION SELECT "
      "cell "
      "FROM count UNION SELECT cell FROM note UNION SELECT cell FROM section UNION SELECT cell "
      "FROM "
      "trace) WHERE cell NOT IN (SELECT id FROM cell)");
  CellRows rows = read_cell_rows(database);
  out.complete = rows.complete;
  for (const CellRow& cell : rows.cells) out.cells.emplace(cell.id, label_of(cell));
  remove_orphans(database);
  if (phases == Phases::optional) remove_damaged_phases(database, rows);
  check_texts(database);
  out.traces = remove_damaged_traces(database);
  remove_damaged(database, file, true);
  transaction.commit();
  return out;
}

/// Adds the cells of `from` that replace or contradict no cell of `database`.
void add_missing(Database& database, const std::filesystem::path& from) {
  database.prepare("ATTACH ? AS source").bind(from.string()).run();
  {
    Transaction transaction(database);
    database.execute(
        "CREATE TEMP TABLE missing AS SELECT id FROM source.cell WHERE id NOT IN (SELECT id FROM "
        "main.cell) AND (position IS NULL OR position NOT IN (SELECT position FROM main.cell WHERE "
        "position IS NOT NULL))");
    database.execute("INSERT INTO main.cell SELECT * FROM source.cell WHERE id IN missing");
    const ScoreLists lists(database, "source.");
    for (const auto& [key, list] : lists.all()) {
      write_list(database, key, list);
    }
    for (const char* table : {"scores", "phase", "count", "note", "section", "trace"}) {
      const std::string name = table;
      database.execute("INSERT INTO main." + name + " SELECT * FROM source." + name +
                       " WHERE cell IN missing ORDER BY cell, rowid");
    }
    for (const char* table : {"input", "sequence_trace", "sequence"}) {
      const std::string name = table;
      database.execute("INSERT INTO main." + name + " SELECT * FROM source." + name +
                       " WHERE sequence_key NOT IN (SELECT sequence_key FROM main.sequence)");
    }
    database.execute("INSERT OR IGNORE INTO main.provenance SELECT * FROM source.provenance");
    if (count(database, "SELECT count(*) FROM main.run") == 0) {
      database.execute("INSERT INTO main.run SELECT * FROM source.run");
    }
    database.execute("DROP TABLE missing");
    for (const char* table : {"cell", "sequence"}) update_sum(database, table);
    for (const char* table : {"run", "provenance"}) update_texts(database, table);
    transaction.commit();
  }
  database.execute("DETACH source");
}

/// Adds to `out` the cells of all views that it lacks. `other`: a file for one view.
void add_views(const PageFile& damaged,
               const std::vector<PageView>& views,
               Phases phases,
               const std::filesystem::path& out,
               const std::filesystem::path& other,
               std::map<std::int64_t, std::string>& found) {
  for (const PageView& view : views) {
    std::filesystem::remove(other);
    found.merge(write_view(damaged, view, other, phases).cells);
    Database database(out, Database::Mode::create);
    add_missing(database, other);
  }
  std::filesystem::remove(other);
}

/// Removes the cells of the store `out` from `lost`, and returns their number.
std::size_t remove_present(const std::filesystem::path& out,
                           std::map<std::int64_t, std::string>& lost) {
  Database database(out, Database::Mode::create);
  const CellRows rows = read_cell_rows(database);
  for (const CellRow& cell : rows.cells) lost.erase(cell.id);
  return rows.cells.size();
}

Salvaged salvage(const PageFile& damaged, const std::filesystem::path& out) {
  Salvaged result;
  const std::filesystem::path other = out.string() + ".other";
  const std::vector<PageView> views = damaged.views();
  if (views.empty()) return result;
  Found best = write_view(damaged, views.front(), out, Phases::required);
  result.nameless = static_cast<std::size_t>(best.nameless);
  result.incomplete = !best.complete;
  result.traces.assign(best.traces.begin(), best.traces.end());
  std::map<std::int64_t, std::string> lost = std::move(best.cells);
  add_views(damaged, {views.begin() + 1, views.end()}, Phases::required, out, other, lost);
  result.cells = remove_present(out, lost);
  if (!lost.empty()) {
    add_views(damaged, views, Phases::optional, out, other, lost);
    const std::size_t before = result.cells;
    result.cells = remove_present(out, lost);
    result.without_phases = result.cells - before;
  }
  for (const auto& [id, label] : lost) result.lost.push_back(label);
  Database database(out, Database::Mode::create);
  result.run_lost = count(database, "SELECT count(*) FROM run") == 0;
  result.unknown_origin = static_cast<std::size_t>(
      count(database,
            "SELECT count(*) FROM cell WHERE provenance_key NOT IN (SELECT provenance_key FROM "
            "provenance)"));
  return result;
}

}  // namespace

Salvaged salvage_store(const std::filesystem::path& damaged, const std::filesystem::path& out) {
  const std::filesystem::path file = store_file(damaged);
  if (std::filesystem::exists(out)) {
    throw InputError(out.string() + ": already exists; salvage writes a new store");
  }
  const FolderLock lock(file.has_parent_path() ? file.parent_path() : ".");
  const std::filesystem::path partial = out.string() + ".partial";
  try {
    if (out.has_parent_path()) std::filesystem::create_directories(out.parent_path());
    remove_files_of(partial);
    const Salvaged result = salvage(PageFile(file), partial);
    if (result.cells == 0) {
      throw InputError(file.string() + ": no intact cell found; nothing was written");
    }
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
