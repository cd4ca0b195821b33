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

/// The cells of a shard, in the order of the sweep. Sequences are dealt out in turn, so that each
/// is loaded by one shard; single cells if there are fewer sequences than shards. O(cells).
std::vector<Cell> cells_of(const Shard& shard, const std::vector<Cell>& cells);

/// Hash of the cells that are divided, equal for shards that belong together.
std::string division_hash(const std::vector<Cell>& cells);

}  // namespace loopbench::harness
