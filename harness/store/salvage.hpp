/// Copies the intact cells of a damaged store into a new one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace loopbench::harness {

struct Salvaged {
  std::size_t cells = 0;            ///< in the new store
  std::vector<std::string> lost;    ///< labels of damaged cells
  std::size_t nameless = 0;         ///< further damaged cells, whose names are lost
  bool incomplete = false;          ///< further cells can be missing without a trace
  std::vector<std::string> traces;  ///< sequences whose trace (data for plots) is lost
  bool run_lost = false;            ///< config and settings; the next `run` writes them again
  std::size_t unknown_origin = 0;   ///< cells whose provenance is lost
  std::size_t without_phases = 0;   ///< cells that lost the durations of their phases only
};

/// Copies every cell of `damaged` whose rows and sequence match their digests into the new store
/// `out`, also cells that are not part of the current config. Reads single pages of the database
/// and of its log, so that unreadable pages, a truncated log or lost tables cost only their own
/// cells. A cell that lost only the durations of its phases is kept without them, because one page
/// holds the phases of more than a hundred cells. `damaged` is only read. Throws InputError, and
/// writes nothing, if `damaged` cannot be opened or is being written, if `out` exists, or if no
/// cell is intact. O(bytes).
Salvaged salvage_store(const std::filesystem::path& damaged, const std::filesystem::path& out);

}  // namespace loopbench::harness
