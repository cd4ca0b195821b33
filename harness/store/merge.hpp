/// Several stores as one.
#pragma once

#include <filesystem>
#include <vector>

namespace loopbench {

struct Merged {
  std::size_t cells = 0;
  std::size_t twice = 0;  ///< cells that were in an earlier store too, left out
};

/// Writes the cells of all `stores` (those their configs ask for) into the new store `out`, whole
/// or not at all. A cell with the same key and labels as an earlier one is left out, unless the
/// earlier one failed and this one did not; two labels for the same both stay. Cells keep their
/// positions where these are free. With `mixed_builds`, a cell that another build made too gets its
/// build into the method's label. Throws InputError: `out` is there, cells of several builds, cells
/// with the same labels that differ in anything else, sequences read from different files.
Merged merge_stores(const std::vector<std::filesystem::path>& stores,
                    const std::filesystem::path& out,
                    bool mixed_builds);

}  // namespace loopbench
