/// Writes the rows of one cell.
#pragma once

#include <set>
#include <string>

#include "harness/model/result.hpp"
#include "harness/provenance/cell_keys.hpp"
#include "harness/store/score_rows.hpp"
#include "harness/store/sqlite.hpp"
#include "harness/store/write_digests.hpp"

namespace loopbench::harness {

/// Statements prepared once for all cells of a sweep.
class CellWriter {
 public:
  /// `provenance_key`: key of the provenance rows for these cells.
  CellWriter(Database& database, std::string provenance_key);

  /// Writes a cell, and its sequence if it is new, in one transaction; replaces the cell at the
  /// same position. Throws InputError; then nothing of the cell is written.
  void write(const CellResult& result, CellKeys& keys);

 private:
  void write_rows(const CellResult& result, CellKeys& keys);
  std::int64_t write_cell(const CellResult& result, CellKeys& keys);
  void write_metadata(const Cell& cell, CellKeys& keys, const SequenceMetadata& metadata);

  Database& database_;
  std::string provenance_key_;
  Statement remove_;
  Statement cell_;
  ScoreWriter scores_;
  Statement phase_;
  Statement count_;
  Statement note_;
  Statement section_;
  Statement trace_;
  DigestWriter digests_;
  std::set<std::string> metadata_;  ///< keys of sequences whose metadata are written
};

/// Removes the cell with that id from every table, but not from the sum of digests.
void remove_cell(Database& database, std::int64_t id);

}  // namespace loopbench::harness
