/// The part of a sweep that `loopbench run` computes: all of it, one shard, or what is missing.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/catalogue/catalogue.hpp"
#include "harness/provenance/cell_keys.hpp"

namespace loopbench::harness {

struct PartArguments {
  std::string shard;            ///< "3/8"; empty: all cells
  std::filesystem::path costs;  ///< store with measured times; empty: estimated costs
  bool missing = false;         ///< only cells that the store in the output folder lacks
  bool dry_run = false;         ///< only list them
};

struct RunPart {
  std::vector<Cell> planned;
  std::filesystem::path out;  ///< folder of the store
  std::string shard;          ///< see Store::set_shard(); empty: not a shard
};

/// The part of `planned` that the arguments select, and its folder: `out` itself, or
/// OUT/shards/3-of-8 for a shard, or OUT/shards/missing-3-of-8 for a shard of the missing cells.
/// `all`: every cell of the sweep. Throws InputError, for example for a missing store.
RunPart select_part(const PartArguments& arguments,
                    CellKeys& keys,
                    const std::vector<Cell>& all,
                    const std::vector<Cell>& planned,
                    const Catalogue& catalogue,
                    const DataRoot& root,
                    const std::filesystem::path& out);

}  // namespace loopbench::harness
