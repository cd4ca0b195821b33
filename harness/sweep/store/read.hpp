/// Reads a store. Only cells of the current config are read; others are kept in the store for
/// reuse. `file` can be the folder with results.sqlite. All functions throw InputError if it is not
/// a store, or if what they read is damaged.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/sweep/model/record.hpp"
#include "harness/sweep/model/sequence_metadata.hpp"
#include "harness/sweep/store/sqlite.hpp"
#include "harness/sweep/store/stored_cells.hpp"

namespace loopbench::harness {

/// All records in sweep order. A metric that failed or was declined completely has a record for
/// every score that it has elsewhere.
std::vector<Record> read_records(const std::filesystem::path& file);

/// One row per cell, in sweep order.
std::vector<CellRow> read_cells(const std::filesystem::path& file);

/// A note and whom it is about.
struct RunNote {
  std::string sequence;
  std::int64_t repeat = 0;
  std::string method;  ///< empty: the run, with all its methods
  Note note;
};

/// What is known about the runs of a store besides their scores.
struct StoredNotes {
  /// Of the runs, in sweep order, then those of single cells that change a conclusion or limit it.
  std::vector<RunNote> notes;
  // Counted only if there are notes.
  std::size_t runs = 0;
  std::size_t sequences = 0;
  std::map<std::string, std::size_t> runs_of_method;
};

/// Remarks of methods are in read_cells() only. In a store of evaluated files, notes of a run are
/// those of the file of a method. O(cells).
StoredNotes read_notes(const std::filesystem::path& file);

/// The `run` table: config text, protocol, baseline, version.
std::map<std::string, std::string> read_run(const std::filesystem::path& file);

/// The alignment of each protocol of the table run, by "LABEL [VERSION]", in order.
std::vector<std::pair<std::string, std::string>> alignments(
    const std::map<std::string, std::string>& run);

/// Commit, compiler, machine and so on. Values that differ between cells are separate lines, in
/// sweep order.
std::map<std::string, std::string> read_provenance(const std::filesystem::path& file);

/// Input files of each sequence, by "LABEL" or "LABEL (repeat N)".
std::map<std::string, std::vector<InputFile>> read_inputs(const std::filesystem::path& file);

/// "DATASET: all options including defaults" of each loaded sequence, by the same labels.
std::map<std::string, std::string> read_dataset_options(const std::filesystem::path& file);

/// One state of a store, also while a sweep is writing it; not thread-safe.
class RecordReader {
 public:
  /// Reads the table of cells and compares the hashes of their scores. `file` can be the folder
  /// with results.sqlite. Throws InputError if it is not a store or is damaged. O(scores); 500
  /// bytes of memory per cell.
  explicit RecordReader(const std::filesystem::path& file);

  /// Visits all records in sweep order, in chunks: every sequence is complete within one chunk, and
  /// a chunk is one sequence, or several if they are small or their cells are mixed. The next chunk
  /// is read on another thread during a visit. Metrics are expanded as described at read_records().
  /// Ends early if `visit` returns false. Throws InputError if the file cannot be read. O(scores).
  void for_each_chunk(const std::function<bool(std::vector<Record>& records)>& visit);

  /// Visits all records one by one, in the same order.
  void for_each(const std::function<void(const Record& record)>& visit);

  /// Restricts these visits to the scores whose kind passes, and to cells without any score.
  void keep_scores(const std::function<bool(const ScoreKind& kind)>& is_kept);

  /// The kinds of all scores of the store.
  std::vector<Shared<ScoreKind>> kinds() const;

 private:
  /// Appends the scores of a cell that are kept.
  void add_cell(const StoredCell& cell, std::vector<Record>& out);
  void step_scores();

  Database database_;
  std::shared_ptr<std::vector<StoredCell>> cells_;         ///< in sweep order
  std::map<std::int64_t, Shared<ScoreKind>> definitions_;  ///< by id
  std::vector<Shared<ScoreKind>> kinds_anywhere_;  ///< of placed cells; empty: no metric failed
  std::string kept_;                               ///< condition of the query of scores
  std::optional<Statement> scores_;                ///< at a row of cell row_cell_
  std::int64_t row_cell_ = 0;                      ///< 0: no more rows
};

}  // namespace loopbench::harness
