#include "harness/shards/run_part.hpp"

#include "datasets/core/error.hpp"
#include "harness/shards/costs.hpp"
#include "harness/shards/shard.hpp"
#include "harness/store/resume.hpp"

namespace loopbench::harness {

RunPart select_part(const PartArguments& arguments,
                    CellKeys& keys,
                    const std::vector<Cell>& all,
                    const std::vector<Cell>& planned,
                    const Catalogue& catalogue,
                    const DataRoot& root,
                    const std::filesystem::path& out) {
  RunPart part{planned, out, ""};
  if (!arguments.costs.empty() && arguments.shard.empty()) {
    throw InputError("--costs: needs --shard, whose division it balances");
  }
  if (arguments.missing) {
    const std::filesystem::path store = out / "results.sqlite";
    if (!std::filesystem::exists(store)) {
      throw InputError("--missing: found no store to complete: " + store.string() +
                       "; set its folder with --out, or run without --missing");
    }
    // Without shards, they are found again when the store is resumed.
    if (arguments.dry_run || !arguments.shard.empty()) {
      part.planned = missing_cells(store, keys, all, planned);
    }
  }
  if (arguments.shard.empty()) return part;
  const Shard shard = parse_shard(arguments.shard);
  const CellCosts costs = arguments.costs.empty()
                              ? estimated_costs(keys.sweep(), part.planned, catalogue, root)
                              : measured_costs(keys.sweep(), part.planned, arguments.costs);
  const std::vector<std::size_t> shards = divide(part.planned, costs, shard.count);
  part.shard = shard.name() + " " + division_hash(part.planned, shards);
  part.planned = cells_of(shard, part.planned, shards);
  part.out = out / "shards" / ((arguments.missing ? "missing-" : "") + shard.folder());
  return part;
}

}  // namespace loopbench::harness
