#include "harness/store/copy_rows.hpp"

#include <string>
#include <utility>

namespace loopbench::harness {

void copy_sequences(Database& database) {
  for (const char* table : {"input", "sequence_trace", "sequence"}) {
    const std::string name = table;
    database.execute("INSERT OR IGNORE INTO main." + name + " SELECT * FROM source." + name +
                     " WHERE sequence_key IN (SELECT sequence_key FROM source.cell WHERE "
                     "position IS NOT NULL)");
  }
}

void copy_details(Database& database, std::int64_t offset) {
  const std::string definition =
      "protocol, protocol_version, times, metric, label, relation, axis, unit, better, target";
  database.execute("INSERT OR IGNORE INTO main.score_definition (" + definition + ") SELECT " +
                   definition + " FROM source.score_definition ORDER BY id");
  // Looked up for every score, so by its key.
  database.execute(
      "CREATE TEMP TABLE renumbered (old INTEGER PRIMARY KEY, new INTEGER); INSERT INTO renumbered "
      "SELECT s.id, m.id FROM source.score_definition s JOIN main.score_definition m USING (" +
      definition + ")");
  database
      .prepare(
          "INSERT INTO main.score_value SELECT cell + ?, number, (SELECT new FROM renumbered "
          "WHERE old = definition), count, rmse, mean, median, std, min, max, sse, pairs, "
          "possible, span, status, why FROM source.score_value WHERE cell IN copied ORDER BY "
          "cell, number")
      .bind(offset)
      .run();
  database.execute("DROP TABLE renumbered");
  for (const auto& [table, columns] :
       {std::pair{"phase", "number, name, seconds"},
        std::pair{"count", "number, name, value"},
        std::pair{"note", "number, text"},
        std::pair{"section", "number, kind, begin_stamp, end_stamp, what"},
        std::pair{"trace", "times, checksum, samples"}}) {
    const std::string name = table;
    const std::string list = columns;
    database
        .prepare("INSERT INTO main." + name + " SELECT cell + ?, " + list + " FROM source." + name +
                 " WHERE cell IN copied ORDER BY cell")
        .bind(offset)
        .run();
  }
}

void copy_texts(Database& database) {
  database.execute(
      "INSERT INTO main.run SELECT key, value FROM source.run WHERE key NOT IN ('exported', "
      "'cells') ON CONFLICT (key) DO UPDATE SET value = CASE WHEN key = 'plan' THEN '' ELSE value "
      "|| "
      "char(10) || excluded.value END WHERE key <> 'baseline' AND instr(char(10) || value || "
      "char(10), char(10) || excluded.value || char(10)) = 0");
  database.execute(
      "INSERT OR IGNORE INTO main.provenance SELECT * FROM source.provenance WHERE "
      "provenance_key IN (SELECT provenance_key FROM source.cell WHERE id IN copied)");
}

}  // namespace loopbench::harness
