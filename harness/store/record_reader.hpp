/// Reads the records of a store a few sequences at a time, so that memory does not grow with the
/// number of scores.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/store/cell_rows.hpp"
#include "harness/store/failed_metrics.hpp"
#include "harness/store/score_lists.hpp"
#include "harness/store/sequence_rows.hpp"
#include "harness/store/sqlite.hpp"

namespace loopbench::harness {

/// One state of a store, also while a sweep is writing it; not thread-safe.
class RecordReader {
 public:
  /// Reads and checks the table of cells. `file` can be the folder with results.sqlite. Throws
  /// InputError if it is not a store or is damaged. O(cells); 250 bytes of memory per cell.
  explicit RecordReader(const std::filesystem::path& file);

  /// Visits all records in sweep order, in chunks: every sequence is complete within one chunk, and
  /// a chunk is one sequence unless their cells are mixed. Metrics are expanded as described at
  /// read_records(). Ends early if `visit` returns false. Throws InputError at the first damaged
  /// cell. O(scores).
  void for_each_chunk(const std::function<bool(std::vector<Record>& records)>& visit);

  /// Whether the scores have more than one protocol.
  bool has_several_protocols() const;

 private:
  void add_cell(std::size_t cell, Statement& scores, std::vector<Record>& out);
  [[noreturn]] void fail(const CellRow& cell);
  void find_scores();

  std::filesystem::path file_;
  Database database_;
  CellRows rows_;
  SequenceRows sequences_;
  ScoreLists lists_;
  std::vector<std::size_t> order_;  ///< in_order(rows_)
  FailedMetrics failed_metrics_;
};

}  // namespace loopbench::harness
