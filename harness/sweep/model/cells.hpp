/// Expansion of a sweep into a flat list of cells, in the order of numbering, storage and output.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/sweep/model/sweep.hpp"

namespace loopbench::harness {

/// One method on one instance of one dataset.
struct Cell {
  std::size_t index = 0;    ///< index in the unfiltered sweep, unaffected by --only
  std::size_t dataset = 0;  ///< index into Sweep::datasets
  std::size_t method = 0;   ///< index into Sweep::methods
  int repeat = 0;
};

/// Number of cells of the sweep before exclusions; the largest std::size_t if there are more.
std::size_t count_cells(const Sweep& sweep, const std::vector<bool>& seeded);

/// Datasets x repeats x methods without exclusions, and without cells whose "SEQUENCE / METHOD"
/// does not contain a match of `only` (empty: all). `seeded[d]`: whether dataset d has a seed;
/// datasets without a seed have one repeat. Throws InputError for an invalid regex, and
/// before anything is built if count_cells() exceeds Limits::cells.
std::vector<Cell> cells(const Sweep& sweep,
                        const std::vector<bool>& seeded,
                        const std::string& only);

/// Seed of a repeat: the given one for repeat 0, then SplitMix64 values, so that neighbouring seeds
/// or repeats do not share a random stream. Never negative.
std::int64_t derived_seed(std::int64_t seed, int repeat);

}  // namespace loopbench::harness
