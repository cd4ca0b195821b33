#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <thread>

#include "harness/base/counted.hpp"
#include "harness/base/print_error.hpp"
#include "harness/base/printable.hpp"
#include "harness/base/sandbox.hpp"
#include "harness/base/write_file.hpp"
#include "harness/catalogue/external_methods.hpp"
#include "harness/catalogue/load_sequence.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/config_path.hpp"
#include "harness/commands/interruption.hpp"
#include "harness/commands/run_output.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/config/read_sweep.hpp"
#include "harness/run/build.hpp"
#include "harness/run/estimate_files.hpp"
#include "harness/run/isolated_sweep.hpp"
#include "harness/run/run_cell.hpp"
#include "harness/store/shard.hpp"
#include "harness/store/store.hpp"
#include "harness/tables/all_records.hpp"

namespace loopbench::harness {
namespace {

struct RunArguments {
  std::string config;
  std::string only;
  std::string data;
  std::string out;
  std::vector<std::filesystem::path> plugins;
  int jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::string shard;  ///< "3/8"; empty: all cells
  bool dry_run = false;
  std::string retry = "none";
  bool fresh = false;
  bool failed_cells_ok = false;
  bool no_sandbox = false;
  bool save_trajectories = false;
};

/// Larger sweeps get no tables and no summary after each run, because they take longer than
/// matching the store with its config and all records do not fit into memory; `table` and `export`
/// read them a few sequences at a time.
constexpr std::size_t kMostCellsInTables = 100'000;

/// Whether the method or a metric failed.
bool has_failure(const CellResult& result) {
  return is_failure(result.status) ||
         std::ranges::any_of(result.scores,
                             [](const ScoreResult& score) { return is_failure(score.status); });
}

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

std::string protocol_names(const Sweep& sweep) {
  std::string out;
  for (const metrics::NamedProtocol& protocol : sweep.protocols) {
    out += fmt::format("{}{} [{}]", out.empty() ? "" : ", ", protocol.label(), protocol.version);
  }
  return out;
}

/// Returns the exit code. Throws InputError, MissingPart.
int run_config(const RunArguments& arguments, const Source& source) {
  const Catalogue known =
      catalogue(with_config_plugins(arguments.plugins, config_path(arguments.config)));
  const Sweep sweep = read_sweep(config_path(arguments.config), known, arguments.data);
  const DataRoot root = data_root(sweep, arguments.data);
  const std::vector<bool> with_seed = seeded(sweep, known);
  const std::vector<Cell> all = cells(sweep, with_seed, "");
  const std::vector<Cell> selected = cells(sweep, with_seed, arguments.only);
  if (selected.empty()) throw InputError(arguments.config + ": no cells to run");
  reject_standard_output("--out", arguments.out);
  const std::filesystem::path given(arguments.out.empty() ? "results/" + sweep.name
                                                          : arguments.out);
  CellKeys keys(sweep, known, root, build_id(source.code));
  const bool is_shard = !arguments.shard.empty();
  const Shard shard = is_shard ? parse_shard(arguments.shard) : Shard{};
  const std::vector<Cell> planned = cells_of(shard, selected);
  const std::filesystem::path out = is_shard ? given / "shards" / shard.folder() : given;
  if (arguments.dry_run) {
    print_plan(sweep, planned);
    try {
      require_parts(sweep, planned, known);
    } catch (const MissingPart& missing) {  // the inputs can be checked without it
      print_error("loopbench: this build cannot run it: {}\n", missing.what());
    }
    return report_bad_inputs(sweep, planned, known, root);
  }
  require_parts(sweep, planned, known);
  if (planned.empty() && is_shard) {
    fmt::print("shard {} has no cells\n", arguments.shard);
    return kExitOk;
  }
  const std::filesystem::path file = out / "results.sqlite";
  SandboxOptions sandbox;
  sandbox.enabled = !arguments.no_sandbox;
  sandbox.hidden = {given, given / "results.sqlite"};
  if (!arguments.data.empty()) sandbox.hidden.emplace_back(arguments.data);
  std::map<std::string, std::string> run_provenance = provenance(source, sweep, known);
  if (arguments.save_trajectories) {
    set_estimate_folder(out / "trajectories");
  }
  if (uses_programs(sweep)) {
    run_provenance["sandbox"] = sandbox.enabled && has_bubblewrap() ? "bubblewrap" : "none";
  }
  std::optional<Store> store(std::in_place, file, keys, run_provenance, arguments.fresh);
  if (is_shard) store->set_shard(shard.name() + " " + division_hash(selected));
  const Resumed resumed = store->resume(all, planned, *from_text<Retry>(arguments.retry));
  report_damage(resumed, file);
  const std::vector<Cell>& missing = resumed.missing;
  std::size_t done = 0;
  std::size_t failed = resumed.failed;
  std::size_t incomplete = resumed.incomplete;
  std::size_t abandoned = 0;
  const StopRequests& interrupted = install_interrupt_handler();
  if (arguments.save_trajectories && resumed.there > 0) {
    print_error(
        "loopbench: {} of earlier runs: their trajectories stay as they were saved, if at all; "
        "--retry all recomputes them\n",
        counted(resumed.there, "cell"));
  }
  if (!missing.empty()) {
    Progress progress(missing.size());
    const std::vector<InputFile> no_inputs;
    std::map<std::string, std::pair<std::string, int>> unsteady;  // first note of a method, count
    const auto finished = [&](const CellResult& r) {
      if (r.status == Status::interrupted) {
        ++abandoned;
        return;
      }
      store->write(r);
      keep_estimate(r.cell, keys.key(r.cell, r.metadata ? r.metadata->inputs : no_inputs));
      ++done;
      if (has_failure(r)) ++failed;
      if (r.status == Status::incomplete) ++incomplete;
      for (const std::string& note : r.report.notes) {
        if (!note.starts_with(kNondeterministic)) continue;
        auto& [first, count] = unsteady[sweep.methods[r.cell.method].label];
        if (count++ == 0) first = note;
      }
      progress.step(sweep.datasets[r.cell.dataset].label + " / " +
                    sweep.methods[r.cell.method].label);
    };
    run_isolated(sweep, missing, known, root, arguments.jobs, sandbox, interrupted, finished);
    for (const auto& [method, note] : unsteady) {
      const int others = note.second - 1;
      const std::string more = others == 0 ? "" : fmt::format(" (and {} more cells)", others);
      print_error("{}\n", printable(method + ": " + note.first + more));
    }
  }
  if (done + resumed.there == 0) return kExitInterrupted;

  const bool is_failure = failed > 0 && !arguments.failed_cells_ok;
  const int exit_code = interrupted > 0 ? kExitInterrupted
                        : is_failure    ? kExitSomeCellsFailed
                                        : kExitOk;
  const auto report_interruption = [&] {
    if (interrupted == 0) return;
    print_error("loopbench: interrupted{}; finished cells are kept, the others run next time\n",
                abandoned == 0 ? "" : fmt::format(", {} running cells abandoned", abandoned));
  };
  if (is_shard) {
    store->close();
    fmt::print("shard {}: {} of {} cells done, {} failed\n{}\nnext, with all shards:\n  {}\n",
               arguments.shard,
               done + resumed.there,
               planned.size(),
               failed,
               printable(file.string()),
               merge_command(given));
    report_interruption();
    return exit_code;
  }

  const bool has_tables = all.size() <= kMostCellsInTables;
  const std::vector<Record> records = has_tables ? all_records(file) : std::vector<Record>{};
  if (has_tables) fmt::print("{}", summary_text(records, sweep));  // even if a table of it fails
  if (has_tables) write_tables(file, sweep, records, out);
  store->close();
  store.reset();
  const std::string earlier =
      resumed.there == 0 ? "" : fmt::format(" ({} of them in earlier runs)", resumed.there);
  const std::string status =
      fmt::format("{} of {} cells done{}, {} failed{}; value: {}; protocol: {}",
                  done + resumed.there,
                  planned.size(),
                  earlier,
                  failed,
                  incomplete == 0 ? "" : fmt::format(", {} incomplete", incomplete),
                  sweep.table.value,
                  protocol_names(sweep));
  fmt::print(
      "{}\n{}{}\n{}",
      fitted(status),
      has_tables ? ""
                 : fmt::format("more than {} cells: no tables and summary\n", kMostCellsInTables),
      printable(
          (out / (has_tables ? "{results.sqlite,table.md,table.csv,rows.csv}" : "results.sqlite"))
              .string()),
      next_commands(out));
  report_interruption();
  return exit_code;
}

}  // namespace

void add_run(CLI::App& app, int& exit_code, const Source& source) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Run the sweep of a config and print a summary");
  command
      ->add_option(
          "config", arguments->config, "YAML file, or the name of an installed config: quickstart")
      ->required();
  command->add_option("--only", arguments->only, "Only cells whose 'SEQUENCE / METHOD' matches")
      ->type_name("REGEX");
  command
      ->add_option("--shard",
                   arguments->shard,
                   "Only this part of N, into its own store OUT/shards/I-of-N; see `merge`")
      ->type_name("I/N");
  command->add_flag("--dry-run",
                    arguments->dry_run,
                    "Check the config and its input files and list the cells without running them");
  command->add_option("-j,--jobs", arguments->jobs, "Number of workers; does not affect results")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_flag("--save-trajectories",
                    arguments->save_trajectories,
                    "Save every cell's estimate at full length, see `export --what trajectories`");
  command->add_flag("--failed-cells-ok",
                    arguments->failed_cells_ok,
                    "Exit with 0 if cells failed: they are results, too, and have their reasons");
  command->add_flag("--no-sandbox", arguments->no_sandbox, "Let external programs read all files");
  command->add_option("--data", arguments->data, "Folder with real datasets")
      ->envname("LOOPBENCH_DATA")
      ->type_name("DIR");
  command->add_option("--out", arguments->out, "Output folder (default: results/CONFIG)")
      ->type_name("DIR");
  command
      ->add_option(
          "--plugin", arguments->plugins, "Shared object with methods, datasets or metrics")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      ->add_option("--retry",
                   arguments->retry,
                   "Stored cells to recompute in addition to damaged ones: failed, or all")
      ->check(CLI::IsMember({"none", "failed", "all"}))
      ->capture_default_str();
  command->add_flag(
      "--fresh", arguments->fresh, "Recompute all cells; keep the old store as previous-N.sqlite");
  command->callback(
      [arguments, source, &exit_code] { exit_code = run_config(*arguments, source); });
}

}  // namespace loopbench::harness
