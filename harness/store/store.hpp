/// The results of one sweep in one SQLite file, written as cells finish and taken up again later.
///
/// Schema: `run` says what was asked for, `provenance` and `input` by and from what it was made;
/// `cell` has a row per cell, `score` one per score, `phase`, `count` and `note` what the method
/// reported, `trace` and `sequence_trace` what a report draws: see schema.hpp. Each cell is one
/// transaction: a killed sweep leaves whole cells only.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/model/result.hpp"
#include "harness/provenance/cell_keys.hpp"
#include "harness/store/folder_lock.hpp"
#include "harness/store/read.hpp"
#include "harness/store/sqlite.hpp"

namespace loopbench {

/// Which cells that are there are run again. What is damaged is in any case; `damaged` looks at
/// traces and indexes too.
enum class Retry { none, failed, damaged, all };
inline auto choices(Retry) {
  return std::array{std::pair{"none", Retry::none},
                    std::pair{"failed", Retry::failed},
                    std::pair{"damaged", Retry::damaged},
                    std::pair{"all", Retry::all}};
}

/// What a store makes of a plan.
struct Resumed {
  std::vector<Cell> missing;         ///< to be run, in order
  std::size_t there = 0;             ///< planned cells that need no run
  std::size_t failed = 0;            ///< of those, kept failures
  std::size_t incomplete = 0;        ///< of those, judged below min_coverage
  bool unchanged = false;            ///< the store holds exactly the sweep, of exactly this config
  std::vector<std::string> damaged;  ///< cells that were, and count as missing; by label
  bool lost = false;      ///< others may have been lost: they were not as many as written
  bool exported = false;  ///< and what is derived from it was written, see Store::exported()
};

class Store {
 public:
  /// Takes the lock of the folder if it is there. A store that is there is opened; with `fresh` it
  /// is kept as `previous.sqlite` beside a new one. Nothing is written before resume() or write().
  /// Throws InputError: another sweep writes, not a store, another schema, damaged.
  Store(std::filesystem::path file,
        CellKeys& keys,
        std::map<std::string, std::string> provenance,
        bool fresh = false);
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// Gives cells that are there their place in the sweep, by their keys, and sets aside the others.
  /// What is not as it was written is taken out first, see damage.hpp.
  /// `all`: every cell of the sweep; `planned`: those that --only leaves. O(cells + bytes of
  /// input).
  Resumed resume(const std::vector<Cell>& all, const std::vector<Cell>& planned, Retry retry);

  /// One transaction; replaces what is at the cell's place. Throws InputError, for example when the
  /// disk is full.
  void write(const CellResult& result);

  /// Says that everything derived from it is written; forgotten by the next change.
  void exported();

 private:
  struct Writer;

  void create();
  void changes();

  std::filesystem::path file_;
  CellKeys& keys_;
  std::map<std::string, std::string> provenance_;
  bool fresh_;
  bool empty_ = false;                ///< a file that is there, without tables
  std::unique_ptr<FolderLock> lock_;  // released after the database is closed
  std::unique_ptr<Database> database_;
  std::unique_ptr<Writer> writer_;
};

}  // namespace loopbench
