/// Bitwise comparison of the cells of two stores.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace loopbench::harness {

struct CellDifference {
  std::string label;  ///< "SEQUENCE / METHOD"
  std::string part;   ///< first that differs: status, score, count, note, section, trace, missing
};

/// The cells of `sample` whose counterpart in `store`, with the same key and labels, is missing or
/// has other contents. Times and memory are not compared, a trace only if both have one. Throws
/// InputError if a store is damaged. O(cells).
std::vector<CellDifference> differing_cells(const std::filesystem::path& sample,
                                            const std::filesystem::path& store);

}  // namespace loopbench::harness
