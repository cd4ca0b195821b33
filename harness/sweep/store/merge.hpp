/// Merging of several stores.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace loopbench::harness {

struct Merged {
  std::size_t cells = 0;
  std::size_t duplicates = 0;  ///< duplicate cells that were skipped
  std::size_t planned = 0;     ///< cells of the sweep; 0: unknown, because the stores differ
  std::size_t missing = 0;     ///< of these, cells that no store has
  std::vector<std::string> instruction_sets;  ///< of the processors that computed the cells
  std::vector<std::string> missing_shards;    ///< "3/8": absent, unlike others of its division
};

struct MergeOptions {
  bool mixed_builds = false;  ///< accept cells of several builds
  bool add = false;           ///< keep the cells of an existing output store, and replace the file
};

/// Writes the cells of all `stores` (those of their current configs) into the new store `out`, one
/// store after the other; on error nothing is written. Skips a cell with the same key and labels as
/// an earlier one, unless the earlier one failed and this one did not; two labels for the same key
/// are both kept. Cells keep their positions where these are free. O(bytes), about 300
/// bytes of memory per cell of the output. Throws InputError if `out` exists (without `add`), for
/// cells of several builds, cells with equal labels but other differences, sequences read from
/// different files, and stores of `eval --store` with different options of reading.
Merged merge_stores(const std::vector<std::filesystem::path>& stores,
                    const std::filesystem::path& out,
                    const MergeOptions& options = {});

}  // namespace loopbench::harness
