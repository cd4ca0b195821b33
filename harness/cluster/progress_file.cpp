#include "harness/cluster/progress_file.hpp"

#include <fstream>
#include <string>
#include <system_error>

#include "harness/text/write_file.hpp"

namespace loopbench::harness {

void ProgressFile::update(const CellCounts& counts) {
  constexpr std::chrono::seconds kInterval{2};
  const auto now = std::chrono::steady_clock::now();
  if (now - written_ < kInterval) return;
  written_ = now;
  write(counts);
}

void ProgressFile::write(const CellCounts& counts) {
  try {
    write_result(file_,
                 std::to_string(counts.done) + " " + std::to_string(counts.total) + " " +
                     std::to_string(counts.failed) + "\n");
  } catch (const std::exception&) {
    // The disk can be full.
  }
}

CellCounts read_progress(const std::filesystem::path& out) {
  CellCounts all;
  std::error_code error;
  for (const auto& shard : std::filesystem::directory_iterator(out / "shards", error)) {
    std::ifstream in(shard.path() / "progress");
    CellCounts own;
    if (!(in >> own.done >> own.total >> own.failed)) continue;
    all.done += own.done;
    all.total += own.total;
    all.failed += own.failed;
  }
  return all;
}

void remove_progress(const std::filesystem::path& out) {
  std::error_code error;
  for (const auto& shard : std::filesystem::directory_iterator(out / "shards", error)) {
    std::filesystem::remove(shard.path() / "progress", error);
  }
}

}  // namespace loopbench::harness
