/// A sweep as a flat list of cells, in the order they are numbered, stored and printed.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/model/sweep.hpp"

namespace loopbench {

/// One method on one instance of one dataset.
struct Cell {
  std::size_t index = 0;    ///< position in the unfiltered sweep: --only does not renumber
  std::size_t dataset = 0;  ///< into Sweep::datasets
  std::size_t method = 0;   ///< into Sweep::methods
  int repeat = 0;
};

/// Datasets x repeats x methods without exclusions, and without cells whose
/// "SEQUENCE / METHOD" does not contain a match of `only` (empty: all). `seeded[d]` says whether
/// dataset d takes a seed: others have nothing to repeat. Throws InputError for a bad regex.
std::vector<Cell> cells(const Sweep& sweep,
                        const std::vector<bool>& seeded,
                        const std::string& only);

/// The seed of a repeat: the given one for repeat 0, then well-mixed ones (SplitMix64), so that
/// neither neighbouring seeds nor neighbouring repeats share a stream. Never negative.
std::int64_t derived_seed(std::int64_t seed, int repeat);

}  // namespace loopbench
