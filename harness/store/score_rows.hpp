/// Scores in a store: one row each in `score_value`, whose texts many cells share as rows of
/// `score_definition`. The view `score` joins them.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "harness/model/record.hpp"
#include "harness/model/result.hpp"
#include "harness/store/digest.hpp"
#include "harness/store/sqlite.hpp"

namespace loopbench::harness {

/// What a score is: protocol, metric, relation, axis, unit and so on.
struct ScoreDefinition {
  Record record;  ///< only these fields are set
  Hash hash;      ///< of the row without its id
};

/// All definitions of a store by id.
class ScoreDefinitions {
 public:
  ScoreDefinitions() = default;
  explicit ScoreDefinitions(Database& database);

  /// nullptr if it is missing.
  const ScoreDefinition* find(std::int64_t id) const;

  const std::map<std::int64_t, ScoreDefinition>& all() const { return all_; }

 private:
  std::map<std::int64_t, ScoreDefinition> all_;
};

/// Writes the scores of cells.
class ScoreWriter {
 public:
  explicit ScoreWriter(Database& database);

  /// Writes all scores of a cell. Call within a transaction. Throws InputError.
  void write(std::int64_t cell, const CellResult& result, const Sweep& sweep);

  /// Call after a transaction was rolled back: definitions that it wrote are not stored.
  void forget() { ids_.clear(); }

 private:
  std::int64_t definition_id(const ScoreResult& score, const Sweep& sweep);

  Statement add_definition_;
  Statement find_definition_;
  Statement value_;
  std::map<std::string, std::int64_t> ids_;  ///< by a hash of the texts
  Database& database_;
};

/// Columns of score_value in the order of reading.
inline constexpr const char* kScoreColumns =
    "cell, number, definition, count, rmse, mean, median, std, min, max, sse, pairs, possible, "
    "span, status, why";

/// Digest of the scores of one cell, in order of their numbers.
class ScoresDigest {
 public:
  /// `row`: a row of kScoreColumns. `definition`: null if it is missing.
  void add(Statement& row, const ScoreDefinition* definition);

  const Hash& value() const { return digest_.value(); }
  std::string text() const { return digest_.text(); }

 private:
  RowsDigest digest_;
  std::string bytes_;
};

/// Reads the columns from `count` on into a record; false if the status is unknown. Statistics of
/// scores without numbers are NULL in the store and zero in the record.
bool read_score(Statement& row, Record& record);

/// Copies the scores of the cells in the temporary table `copied` from the attached database
/// `source`, and adds `offset` to the ids of their cells.
void copy_scores(Database& database, std::int64_t offset);

}  // namespace loopbench::harness
