/// Merging of several stores.
#pragma once

#include <filesystem>
#include <vector>

namespace loopbench::harness {

struct Merged {
  std::size_t cells = 0;
  std::size_t duplicates = 0;  ///< duplicate cells that were skipped
};

/// Writes the cells of all `stores` (those of their current configs) into the new store `out`; on
/// error nothing is written. Skips a cell with the same key and labels as an earlier one, unless
/// the earlier one failed and this one did not; two labels for the same key are both kept. Cells
/// keep their positions where these are free. With `mixed_builds`, the build is added to the method
/// label of a cell that another build also computed. Throws InputError if `out` exists, for cells
/// of several builds, cells with equal labels but other differences, and sequences read from
/// different files.
Merged merge_stores(const std::vector<std::filesystem::path>& stores,
                    const std::filesystem::path& out,
                    bool mixed_builds);

}  // namespace loopbench::harness
