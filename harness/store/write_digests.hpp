/// Writing the digests of a store, always in the transaction that writes what they are of.
#pragma once

#include <string>
#include <vector>

#include "harness/store/digest.hpp"
#include "harness/store/sqlite.hpp"

namespace loopbench {

/// Digests of single rows and of what belongs to them, read back from the tables.
class DigestWriter {
 public:
  explicit DigestWriter(Database& database);

  /// Of the cell with that id and of its rows in every other table; into the sum of cells too.
  void add_cell(std::int64_t id);

  /// Of the cell's own row, after its labels or its place have changed. Not into the sum.
  void renew_cell(std::int64_t id);

  /// Of that sequence's row, inputs and trace; into the sum of sequences too.
  void add_sequence(const std::string& sequence_key);

  /// Takes a row about to go out of the sum of its table, cell or sequence.
  void remove(const std::string& table, const std::string& digest);

 private:
  template <class Key>
  std::string digest_of(Statement& rows, const Key& key);
  template <class Key>
  std::string renew(Statement& row, Statement& set, const Key& key);
  void change_sum(const std::string& table,
                  const std::string& digest,
                  void (SumOfDigests::*change)(std::string_view));

  std::vector<Statement> details_;  ///< score, phase, count, note, section, trace of a cell
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

/// The sum of a table's digests, cell or sequence, from its rows. O(rows).
std::string sum_of_digests(Database& database, const std::string& table);
void renew_sum(Database& database, const std::string& table);

/// The digest of a table of texts, run or provenance.
std::string digest_of_texts(Database& database, const std::string& table);
void renew_texts(Database& database, const std::string& table);

/// What the store says of a table: cell, sequence, run or provenance.
std::string written_digest(Database& database, const std::string& table);

}  // namespace loopbench
