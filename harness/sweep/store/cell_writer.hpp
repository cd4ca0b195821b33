/// Writes the rows of one cell.
#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "harness/sweep/model/record.hpp"
#include "harness/sweep/model/result.hpp"
#include "harness/sweep/run/cell_keys.hpp"
#include "harness/sweep/store/schema.hpp"
#include "harness/sweep/store/sqlite.hpp"

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
  void write_scores(std::int64_t id, const CellResult& result, const Sweep& sweep);
  void write_report(std::int64_t id, const CellResult& result);
  /// Returns the key of their rows.
  std::string write_notes(const std::vector<Note>& notes);
  void write_note(std::int64_t id, std::int64_t number, const Note& note);
  void write_trace(std::int64_t id, const CellTrace& trace);
  std::int64_t definition_of(const ScoreKind& kind);
  void write_metadata(const Cell& cell, CellKeys& keys, const SequenceMetadata& metadata);

  Database& database_;
  std::string provenance_key_;
  Statement replaced_;
  Statement cell_;
  Statement definition_;
  Statement score_;
  Statement phase_;
  Statement count_;
  Statement note_;
  Statement section_;
  Statement trace_;
  Statement pose_value_;
  std::set<std::int64_t> definitions_;  ///< ids of those that are written
  std::set<std::string> sequences_;     ///< keys of those that are written
  std::set<std::string> notes_;         ///< likewise
};

}  // namespace loopbench::harness
