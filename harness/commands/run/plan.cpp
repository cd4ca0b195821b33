#include "harness/commands/run/plan.hpp"

#include "datasets/core/error.hpp"
#include "harness/commands/config_path.hpp"
#include "harness/sweep/catalogue/external_methods.hpp"
#include "harness/sweep/catalogue/load_sequence.hpp"
#include "harness/sweep/catalogue/loading.hpp"
#include "harness/sweep/config/read_sweep.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/store/find_stores.hpp"
#include "harness/sweep/store/store.hpp"

namespace loopbench::harness {
namespace {

/// The folders that relative paths are searched in: the config's, then `data` if given.
DataRoot data_root(const Sweep& sweep, const std::string& data) {
  const std::filesystem::path beside = sweep.config.parent_path();
  DataRoot root{{beside.empty() ? "." : beside}};
  if (data.empty()) return root;
  if (!std::filesystem::is_directory(data)) {
    throw InputError(data +
                     ": is not a folder; set --data or $LOOPBENCH_DATA to a folder with data");
  }
  root.folders.emplace_back(data);
  return root;
}

}  // namespace

RunPlan plan(const RunArguments& arguments) {
  RunPlan out;
  const std::filesystem::path config = config_path(arguments.config);
  out.known = catalogue(with_config_plugins(arguments.plugins, config));
  out.sweep = read_sweep(config, out.known, arguments.data);
  out.root = data_root(out.sweep, arguments.data);
  const std::vector<bool> with_seed = seeded(out.sweep, out.known);
  out.all = cells(out.sweep, with_seed, "");
  out.selected = cells(out.sweep, with_seed, arguments.only);
  if (out.selected.empty()) throw InputError(arguments.config + ": no cells to run");
  reject_standard_output("--out", arguments.out);
  out.given = arguments.out.empty() ? "results/" + out.sweep.name : arguments.out;
  if (!arguments.shard.empty()) out.shard = parse_shard(arguments.shard);
  out.planned = cells_of(out.shard.value_or(Shard{}), out.selected);
  out.out = out.shard ? out.given / "shards" / out.shard->folder() : out.given;
  return out;
}

SandboxOptions sandbox_of_sweep(const RunPlan& plan, const RunArguments& arguments) {
  namespace fs = std::filesystem;
  SandboxOptions out;
  out.enabled = !arguments.no_sandbox;
  if (!uses_programs(plan.sweep)) return out;
  for (const DatasetChoice& choice : plan.sweep.datasets) {
    if (choice.dataset.name == "simulated") continue;  // its path is no file
    for (const fs::path& each : files_of_options(choice.dataset.options, plan.root)) {
      out.hidden.push_back(each);
    }
  }
  if (!arguments.data.empty()) out.hidden.emplace_back(arguments.data);
  for (const fs::path& each :
       {plan.given, plan.given / "results.sqlite", fs::temp_directory_path(), cache_folder()}) {
    if (!each.empty()) out.hidden.push_back(each);
  }
  const std::vector<fs::path> near{plan.root.folders.front(), folder_of(plan.given), "."};
  for (const fs::path& part : stores_in(near)) out.hidden.push_back(part);
  return out;
}

}  // namespace loopbench::harness
