/// Progress of a shard in a file next to its store, readable from other machines: SQLite's
/// write-ahead log is not, on a network file system.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>

namespace loopbench::harness {

struct CellCounts {
  std::size_t done = 0;
  std::size_t total = 0;
  std::size_t failed = 0;
};

/// Writes FOLDER/progress, "DONE TOTAL FAILED" in one line, when a cell has finished, at most every
/// two seconds. Errors are ignored: the store has what counts.
class ProgressFile {
 public:
  explicit ProgressFile(const std::filesystem::path& folder) : file_(folder / "progress") {}

  void update(const CellCounts& counts);
  void write(const CellCounts& counts);  ///< at once

 private:
  std::filesystem::path file_;
  std::chrono::steady_clock::time_point written_{};
};

/// Sum over the files OUT/shards/*/progress. O(shards).
CellCounts read_progress(const std::filesystem::path& out);

/// Removes these files, which can be of another number of shards. O(shards).
void remove_progress(const std::filesystem::path& out);

}  // namespace loopbench::harness
