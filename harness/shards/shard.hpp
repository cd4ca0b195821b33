/// Division of a sweep into shards that run on different machines.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/model/cells.hpp"

namespace loopbench::harness {

/// One of `count` parts of a sweep, numbered from 1.
struct Shard {
  std::size_t number = 1;
  std::size_t count = 1;

  std::string name() const;    ///< "3/8"
  std::string folder() const;  ///< "3-of-8"
};

/// "3/8". Throws InputError for any other text.
Shard parse_shard(const std::string& text);

/// Estimated duration of the cells of a sweep.
struct CellCosts {
  std::vector<double> cells;  ///< of each cell [s]
  double load = 0.0;          ///< of loading a sequence [s]
};

/// The shard, from 1 to `count`, of each cell. Cells of one sequence are in one shard, unless that
/// makes the largest shard exceed the mean by more than 5 %: then long sequences are split into
/// consecutive cells. Longest processing time first (Graham 1969): the largest shard is at most 4/3
/// of the optimum of these parts. Depends on the arguments only. O(n log n).
std::vector<std::size_t> divide(const std::vector<Cell>& cells,
                                const CellCosts& costs,
                                std::size_t count);

/// Hash of a division, equal for shards that belong together.
std::string division_hash(const std::vector<Cell>& cells, const std::vector<std::size_t>& shards);

/// The cells of a shard, in the order of the sweep.
std::vector<Cell> cells_of(const Shard& shard,
                           const std::vector<Cell>& cells,
                           const std::vector<std::size_t>& shards);

}  // namespace loopbench::harness
