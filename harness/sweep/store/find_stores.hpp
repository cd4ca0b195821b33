/// Stores and data near a sweep, which programs must not read.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/dataset.hpp"

namespace loopbench::harness {

/// Whether a file is a store: its first pages have the definition of a table that only stores have.
inline bool is_store(const std::filesystem::path& file) {
  constexpr std::streamsize kPages = 256 << 10;  // [bytes]
  std::ifstream in(file, std::ios::binary);
  std::string text(static_cast<std::size_t>(kPages), '\0');
  in.read(text.data(), kPages);
  return text.starts_with("SQLite format 3") &&
         text.find("provenance_key TEXT NOT NULL") != std::string::npos;
}

/// The stores in these folders, up to four folders below them: their folders, their files and their
/// saved trajectories, each by itself. Looks at most at 20,000 entries of each.
inline std::vector<std::filesystem::path> stores_in(
    const std::vector<std::filesystem::path>& folders) {
  namespace fs = std::filesystem;
  constexpr int kDeepest = 4;
  constexpr std::size_t kMostEntries = 20'000;
  std::vector<fs::path> out;
  for (const fs::path& folder : folders) {
    std::error_code error;
    const auto options = fs::directory_options::skip_permission_denied;
    std::size_t seen = 0;
    fs::recursive_directory_iterator entry(folder, options, error);
    for (; entry != fs::recursive_directory_iterator() && !error; entry.increment(error)) {
      if (++seen > kMostEntries) break;
      if (entry.depth() >= kDeepest) entry.disable_recursion_pending();
      const fs::path& path = entry->path();
      const std::string name = path.filename().string();
      const bool is_database = path.extension() == ".sqlite" && entry->is_regular_file(error);
      if (!is_database || !is_store(path)) continue;
      for (const char* const tail : {"", "-wal", "-shm"}) out.push_back(path.string() + tail);
      if (name == "results.sqlite") out.push_back(path.parent_path());
      out.push_back(path.parent_path() / "trajectories");
    }
  }
  return out;
}

/// Existing files, and folders of recordings, that options of a dataset name, in the folders of
/// `root`; not the files of its program.
inline std::vector<std::filesystem::path> files_of_options(const Params& options,
                                                           const DataRoot& root) {
  std::vector<std::filesystem::path> out;
  for (const auto& [name, value] : options) {
    const auto* const text = std::get_if<std::string>(&value);
    if (text == nullptr || text->empty() || name == "depends") continue;
    for (const std::filesystem::path& folder : root.folders) {
      std::error_code error;
      const std::filesystem::path file = folder / file_of(*text);
      const bool is_recording =
          (name == "path" || name == "sequence") && std::filesystem::is_directory(file, error);
      if (is_recording || std::filesystem::is_regular_file(file, error)) out.push_back(file);
    }
  }
  return out;
}

}  // namespace loopbench::harness
