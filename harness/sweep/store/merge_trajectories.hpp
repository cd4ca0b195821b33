/// Saved trajectories of stores that are merged.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/sweep/run/estimate_files.hpp"
#include "harness/sweep/store/open.hpp"
#include "harness/sweep/store/sqlite.hpp"

namespace loopbench::harness {

/// Copies the trajectories that were saved beside `stores` into the folder `to`: those of the cells
/// of `merged`. O(cells * stores). Throws InputError.
inline void merge_trajectories(const std::vector<std::filesystem::path>& stores,
                               const std::filesystem::path& merged,
                               const std::filesystem::path& to) {
  std::vector<std::filesystem::path> from;
  for (const std::filesystem::path& store : stores) {
    std::error_code none;
    const std::filesystem::path folder = folder_of(store_file(store)) / "trajectories";
    const bool is_other = !std::filesystem::equivalent(folder, to, none);
    if (std::filesystem::is_directory(folder, none) && is_other) from.push_back(folder);
  }
  if (from.empty()) return;
  Database database(merged, Database::Mode::read);
  Statement row =
      database.prepare("SELECT DISTINCT key, content FROM cell JOIN sequence USING (sequence_key)");
  while (row.step()) {
    const std::string key = row.text();
    const std::string content = row.text();
    for (const std::filesystem::path& folder : from) copy_estimates(folder, to, key, content);
  }
}

}  // namespace loopbench::harness
