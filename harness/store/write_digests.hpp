/// Writes the digests of a store, in the same transaction as the data.
#pragma once

#include <string>
#include <vector>

#include "harness/store/digest.hpp"
#include "harness/store/score_rows.hpp"
#include "harness/store/sqlite.hpp"

namespace loopbench::harness {

/// Digests of single rows and of their related rows, read back from the tables.
class DigestWriter {
 public:
  explicit DigestWriter(Database& database);

  /// Updates the digest of the cell with that id and of its rows in other tables, and the sum.
  void add_cell(std::int64_t id);

  /// Updates the digest of the cell's own row after a change of labels or position. Not the sum.
  void update_cell(std::int64_t id);

  /// Updates the digest of that sequence's row, inputs and trace, and the sum.
  void add_sequence(const std::string& sequence_key);

  /// Subtracts a row that will be removed from the sum of its table, cell or sequence.
  void remove(const std::string& table, const std::string& digest);

  /// Call after a transaction was rolled back.
  void forget() { definitions_ = {}; }

 private:
  std::string digest_of_scores(std::int64_t cell);
  template <class Key>
  std::string digest_of(Statement& rows, const Key& key);
  template <class Key>
  std::string update(Statement& row, Statement& set, const Key& key);
  void change_sum(const std::string& table,
                  const std::string& digest,
                  void (SumOfDigests::*change)(std::string_view));

  Database& database_;
  ScoreDefinitions definitions_;
  Statement scores_;
  std::vector<Statement> details_;  ///< phase, count, note, section, trace of a cell
  Statement set_details_;
  Statement cell_;
  Statement set_cell_;
  Statement inputs_;
  Statement sequence_trace_;
  Statement set_sequence_details_;
  Statement sequence_;
  Statement set_sequence_;
  Statement sum_;
  Statement set_sum_;
};

/// Sum of a table's digests, cell or sequence, computed from its rows. O(rows).
std::string sum_of_digests(Database& database, const std::string& table);
void update_sum(Database& database, const std::string& table);

/// Digest of a table of texts, run or provenance.
std::string digest_of_texts(Database& database, const std::string& table);
void update_texts(Database& database, const std::string& table);

/// Stored digest of a table: cell, sequence, run or provenance.
std::string written_digest(Database& database, const std::string& table);

}  // namespace loopbench::harness
