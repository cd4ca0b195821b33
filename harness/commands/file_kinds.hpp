/// Content of existing files, by which commands decide whether they may replace them.
#pragma once

#include <filesystem>
#include <string>

namespace loopbench::harness {

/// What an option writes.
enum class FileKind {
  trajectory,  ///< in any format
  stamps,      ///< one number per line
  printed,     ///< tables, texts, CSV and JSON of results
  page,        ///< HTML of `report`
  figure,
  drawing_script,  ///< Python script or data of a figure
  job_script,      ///< of `submit`
  baseline
};

/// "a trajectory"
std::string noun_of(FileKind kind);

/// "a store of results", "a config" or "a baseline" for files that are never replaced by something
/// else; empty for others. Reads at most 64 KiB.
std::string protected_content(const std::filesystem::path& file);

/// Whether the file is empty, or has the content of this kind as loopbench writes or reads it.
/// Reads its first and last 64 KiB.
bool has_kind(const std::filesystem::path& file, FileKind kind);

}  // namespace loopbench::harness
