/// Scores that were computed elsewhere, put back into a store.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "datasets/core/fields.hpp"
#include "harness/model/record.hpp"
#include "harness/store/cell_writer.hpp"
#include "harness/store/open.hpp"
#include "harness/store/stored_cells.hpp"
#include "metrics/evaluation/evaluation.hpp"
#include "metrics/metric.hpp"

namespace loopbench::harness {

struct ImportedScore {
  std::string source;  ///< "scores.csv:3", for messages
  std::string key;     ///< of the cell
  metrics::Times times = metrics::Times::keyframes;
  std::string metric;
  metrics::Score score;
};

/// Id of the definition, which is written if it is new.
inline std::int64_t definition_id(Database& database, const ImportedScore& imported) {
  const metrics::Score& score = imported.score;
  const std::string columns = "?1,?2,?3,?4,?5,?6,?7,?8,?9,?10";
  const auto bind = [&](Statement statement) {
    statement.bind(kImported, "", to_text(imported.times), imported.metric)
        .bind(imported.metric + " (" + kImported + ")", score.relation, score.axis, score.unit)
        .bind(to_text(score.better), score.target);
    return statement;
  };
  bind(database.prepare("INSERT OR IGNORE INTO score_definition VALUES (row_checksum(" + columns +
                        ")," + columns + ")"))
      .run();
  Statement id = bind(database.prepare("SELECT row_checksum(" + columns + ")"));
  id.step();
  return id.integer();
}

/// Adds the scores to the cells with their keys, in one transaction; those with the same labels as
/// earlier imported ones replace them. Returns the number of changed cells. Throws InputError if
/// no cell has a key, another sweep is writing, or the file is not a store. O(scores).
inline std::size_t import_scores(const std::filesystem::path& store,
                                 const std::vector<ImportedScore>& scores) {
  const std::filesystem::path file = store_file(store);
  const FolderLock lock(folder_of(file));
  Database database(file, Database::Mode::create);
  check_schema(database, file);
  Transaction transaction(database);
  Statement cells = database.prepare("SELECT id FROM cell WHERE key = ?");
  Statement remove = database.prepare("DELETE FROM score_value WHERE cell = ? AND definition = ?");
  Statement next =
      database.prepare("SELECT coalesce(max(number), -1) + 1 FROM score_value WHERE cell = ?");
  Statement insert = insert_into(database, kScoreTable);
  std::set<std::int64_t> changed;
  for (const ImportedScore& each : scores) {
    std::vector<std::int64_t> ids;
    cells.bind(each.key);
    while (cells.step()) ids.push_back(cells.integer());
    cells.reset();
    if (ids.empty()) {
      throw InputError(each.source + ": found key '" + each.key + "', expected that of a cell of " +
                       file.string() + ": index.csv of `export --what trajectories` lists them");
    }
    const std::int64_t definition = definition_id(database, each);
    for (const std::int64_t id : ids) {
      remove.bind(id, definition).run();
      next.bind(id).step();
      const std::int64_t number = next.integer();
      next.reset();
      const metrics::Statistics& s = each.score.statistics;
      insert.bind(id, number, definition)
          .bind(s.count, s.rmse, s.mean, s.median, s.std, s.min, s.max, s.sse, s.p90, s.p95, s.p99)
          .bind(0, 0, 1.0, "ok", "")  // pairs are unknown
          .run();
      changed.insert(id);
    }
  }
  Statement count = database.prepare(
      "UPDATE cell SET scores = (SELECT count(*) FROM score_value WHERE cell = ?1) WHERE id = ?1");
  Statement set_checksum = checksum_update(database);
  for (const std::int64_t id : changed) {
    count.bind(id).run();
    set_checksum.bind(id).run();
  }
  transaction.commit();
  return changed.size();
}

}  // namespace loopbench::harness
