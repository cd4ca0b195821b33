#include "harness/store/score_rows.hpp"

#include "harness/text/hash.hpp"

namespace loopbench::harness {
namespace {

constexpr const char* kDefinitionColumns =
    "protocol, protocol_version, times, metric, label, relation, axis, unit, better, target";

constexpr const char* kSameDefinition =
    "protocol = ? AND protocol_version = ? AND times = ? AND metric = ? AND label = ? AND relation "
    "= ? AND axis = ? AND unit = ? AND better = ? AND target = ?";

}  // namespace

ScoreDefinitions::ScoreDefinitions(Database& database) {
  Statement row = database.prepare(std::string("SELECT id, ") + kDefinitionColumns +
                                   " FROM score_definition ORDER BY id");
  while (row.step()) {
    ScoreDefinition& d = all_[row.integer()];
    d.hash = digest_of_row(row, 1, row.columns());
    Record& r = d.record;
    for (SharedText* text : {&r.protocol,
                             &r.protocol_version,
                             &r.times,
                             &r.metric,
                             &r.label,
                             &r.relation,
                             &r.axis,
                             &r.unit}) {
      *text = row.view();
    }
    r.better = from_text<metrics::Better>(row.text()).value_or(metrics::Better::neither);
    r.target = row.real();
  }
}

const ScoreDefinition* ScoreDefinitions::find(std::int64_t id) const {
  const auto found = all_.find(id);
  return found == all_.end() ? nullptr : &found->second;
}

ScoreWriter::ScoreWriter(Database& database)
    : add_definition_(database.prepare(std::string("INSERT INTO score_definition (") +
                                       kDefinitionColumns + ") VALUES (?,?,?,?,?,?,?,?,?,?)")),
      find_definition_(database.prepare(std::string("SELECT id FROM score_definition WHERE ") +
                                        kSameDefinition)),
      value_(database.prepare(std::string("INSERT INTO score_value (") + kScoreColumns +
                              ") VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)")),
      database_(database) {}

std::int64_t ScoreWriter::definition_id(const ScoreResult& score, const Sweep& sweep) {
  const metrics::NamedProtocol& protocol = sweep.protocols[score.protocol];
  const std::string texts[] = {protocol.label(),
                               protocol.version,
                               to_text(score.times),
                               score.metric,
                               score.label,
                               score.score.relation,
                               score.score.axis,
                               score.score.unit,
                               to_text(score.score.better)};
  Fields fields;
  for (const std::string& text : texts) fields.add(text);
  const std::string key = fields.add(std::to_string(score.score.target)).hashed();
  if (const auto known = ids_.find(key); known != ids_.end()) return known->second;
  const auto bind_all = [&](Statement& statement) -> Statement& {
    for (const std::string& text : texts) statement.bind(text);
    return statement.bind(score.score.target);
  };
  const bool is_stored = bind_all(find_definition_).step();
  std::int64_t id = is_stored ? find_definition_.integer() : 0;
  find_definition_.reset();
  if (!is_stored) {
    bind_all(add_definition_).run();
    id = database_.last_row();
  }
  ids_.emplace(key, id);
  return id;
}

void ScoreWriter::write(std::int64_t cell, const CellResult& result, const Sweep& sweep) {
  std::int64_t number = 0;
  for (const ScoreResult& score : result.scores) {
    const metrics::Statistics& s = score.score.statistics;
    value_.bind(cell).bind(number++).bind(definition_id(score, sweep));
    if (has_numbers(score.status)) {
      value_.bind(static_cast<std::int64_t>(s.count));
      for (const double value : {s.rmse, s.mean, s.median, s.std, s.min, s.max, s.sse}) {
        value_.bind(value);
      }
    } else {
      for (int i = 0; i < 8; ++i) value_.bind_null();
    }
    value_.bind(static_cast<std::int64_t>(score.coverage.pairs))
        .bind(static_cast<std::int64_t>(score.coverage.possible))
        .bind(score.coverage.span)
        .bind(to_text(score.status))
        .bind(score.why)
        .run();
  }
}

void ScoresDigest::add(Statement& row, const ScoreDefinition* definition) {
  bytes_.clear();
  row.append_columns(1, 2, bytes_);
  bytes_ += hex(definition == nullptr ? Hash{} : definition->hash);
  row.append_columns(3, row.columns(), bytes_);
  digest_.add(bytes_);
}

bool read_score(Statement& row, Record& record) {
  metrics::Statistics& s = record.statistics;
  s.count = static_cast<std::size_t>(row.integer());
  for (double* value : {&s.rmse, &s.mean, &s.median, &s.std, &s.min, &s.max, &s.sse}) {
    *value = row.real();
  }
  record.pairs = row.integer();
  record.possible = row.integer();
  record.span = row.real();
  const std::optional<Status> status = from_text<Status>(row.text());
  if (!status) return false;
  if (!has_numbers(*status)) s = {};
  record.status = *status;
  record.why = row.view();
  return true;
}

void copy_scores(Database& database, std::int64_t offset) {
  const std::string names = kDefinitionColumns;
  database.execute("INSERT OR IGNORE INTO main.score_definition (" + names + ") SELECT " + names +
                   " FROM source.score_definition ORDER BY id");
  database.execute(
      "DROP TABLE IF EXISTS temp.definition_ids; CREATE TEMP TABLE definition_ids (source INTEGER "
      "PRIMARY KEY, id INTEGER NOT NULL); INSERT INTO definition_ids SELECT s.id, m.id FROM "
      "source.score_definition s JOIN main.score_definition m USING (" +
      names + ")");
  database
      .prepare(std::string("INSERT INTO main.score_value (") + kScoreColumns +
               ") SELECT v.cell + ?, v.number, d.id, count, rmse, mean, median, std, min, max, "
               "sse, pairs, possible, span, status, why FROM copied c CROSS JOIN "
               "source.score_value v ON v.cell = c.id JOIN definition_ids d ON d.source = "
               "v.definition ORDER BY v.cell, v.number")
      .bind(offset)
      .run();
}

}  // namespace loopbench::harness
