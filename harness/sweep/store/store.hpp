/// Results of one sweep in one SQLite file, written as cells finish, and resumed by later runs.
///
/// Schema: `run` holds the configuration, `provenance` and `input` the build and the input files;
/// `cell` has a row per cell and the view `score` one per score; `phase`, `count` and
/// `note` the method's report, `trace` and `sequence_trace` data for plots: see schema.hpp. Each
/// cell is one transaction, so a killed sweep leaves only complete cells.
///
/// Durability: the store is written in WAL mode with `synchronous = NORMAL`. Once write()
/// has returned, no end of the process can lose the cell. It is on the disk, and survives a power
/// cut, after the next sync(), which write() calls every 10 s, and after the destructor, so before
/// `run` reports the end of the sweep. A power cut can lose the cells since the last sync, each
/// completely; the next `run` recomputes them. It never damages the file, if the disk writes what
/// it reports as synced. While another program reads the store, syncs can be postponed.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/sweep/model/result.hpp"
#include "harness/sweep/run/cell_keys.hpp"
#include "harness/sweep/store/open.hpp"
#include "harness/sweep/store/read.hpp"
#include "harness/sweep/store/sqlite.hpp"

namespace loopbench::harness {

/// Stored cells to run again. Damaged cells are always recomputed.
enum class Retry { none, failed, all };
inline auto choices(Retry) {
  return std::array{std::pair{"none", Retry::none},
                    std::pair{"failed", Retry::failed},
                    std::pair{"all", Retry::all}};
}

/// Result of matching a store with a plan.
struct Resumed {
  std::vector<Cell> missing;         ///< to be run, in order
  std::size_t there = 0;             ///< planned cells with stored results
  std::size_t failed = 0;            ///< of those, failures
  std::size_t incomplete = 0;        ///< of those, with coverage below min_coverage
  bool unchanged = false;            ///< the store holds exactly this sweep and config
  std::vector<std::string> damaged;  ///< labels of damaged cells, which count as missing
};

class CellWriter;

class Store {
 public:
  /// `file` can be a memory_store(). Creates and locks its folder. Opens an existing store; with
  /// `fresh` keeps it as `previous-N.sqlite` next to a new one. Writes nothing before resume() or
  /// write(): then the destructor removes a folder that is new. Throws InputError if another sweep
  /// is writing, or the file is not a store, has another schema, or is damaged.
  Store(std::filesystem::path file,
        CellKeys& keys,
        std::map<std::string, std::string> provenance,
        bool fresh = false);
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// Matches stored cells with the sweep by their keys, and marks the others as unused. Damaged
  /// cells are removed first, and damaged rows of run and provenance are written again. `all`:
  /// every cell of the sweep; `planned`: those selected by --only. O(bytes of the store and input).
  Resumed resume(const std::vector<Cell>& all, const std::vector<Cell>& planned, Retry retry);

  /// Records that this store holds one shard of a sweep: "3/8 DIVISION", see division_hash(). Call
  /// before resume().
  void set_shard(const std::string& shard) { shard_ = shard; }

  /// Writes a cell in one transaction; replaces the cell at its position. Throws InputError, for
  /// example if the disk is full.
  void write(const CellResult& result);

  /// Waits until everything is on the disk and leaves a single file. Call at the end: the
  /// destructor does the same without errors. Throws InputError, for example if the disk fails.
  void close();

 private:
  /// Waits until all written cells are on the disk. Throws InputError.
  void sync();
  void create();
  /// Writes what has changed of the table run; whether nothing has.
  bool update_description();

  std::filesystem::path file_;
  CellKeys& keys_;
  std::map<std::string, std::string> provenance_;
  bool fresh_;
  std::size_t planned_ = 0;  ///< cells of the sweep; 0: unknown
  std::string shard_;        ///< empty: not a shard
  bool empty_ = false;       ///< the file exists, but without tables
  std::chrono::steady_clock::time_point synced_ = std::chrono::steady_clock::now();
  std::unique_ptr<FolderLock> lock_;  // released after the database is closed
  std::unique_ptr<Database> database_;
  std::unique_ptr<CellWriter> writer_;
};

}  // namespace loopbench::harness
