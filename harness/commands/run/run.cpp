#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <optional>

#include "harness/answers/tables/store_tables.hpp"
#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/interruption.hpp"
#include "harness/commands/run/plan.hpp"
#include "harness/commands/run/run_output.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/sweep/catalogue/external_methods.hpp"
#include "harness/sweep/catalogue/loading.hpp"
#include "harness/sweep/model/note_text.hpp"
#include "harness/sweep/process/sandbox.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/run/build.hpp"
#include "harness/sweep/run/estimate_files.hpp"
#include "harness/sweep/run/isolated_sweep.hpp"
#include "harness/sweep/run/run_cell.hpp"
#include "harness/sweep/store/shard.hpp"
#include "harness/sweep/store/store.hpp"
#include "harness/sweep/text/counted.hpp"
#include "harness/sweep/text/print_error.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {
namespace {

/// Whether the method or a metric failed.
bool has_failure(const CellResult& result) {
  return is_failure(result.status) ||
         std::ranges::any_of(result.scores,
                             [](const ScoreResult& score) { return is_failure(score.status); });
}

/// Runs the cells that the store lacks and writes them to it.
CellCounts compute(const RunPlan& plan,
                   const RunArguments& arguments,
                   CellKeys& keys,
                   Store& store) {
  const Sweep& sweep = plan.sweep;
  const Resumed resumed = store.resume(plan.all, plan.planned, *from_text<Retry>(arguments.retry));
  report_damage(resumed, plan.store());
  CellCounts out{resumed.there, resumed.there, resumed.failed, resumed.incomplete};
  const StopRequests& interrupted = install_interrupt_handler();
  if (arguments.save_trajectories && resumed.there > 0) {
    print_error(
        "loopbench: {} of earlier runs: their trajectories stay as they were saved, if at all; "
        "--retry all recomputes them\n",
        counted(resumed.there, "cell"));
  }
  if (resumed.missing.empty()) return out;
  Progress progress(resumed.missing.size());
  const std::vector<InputFile> no_inputs;
  std::map<std::string, std::pair<Note, int>> unsteady;  // first note of a method, count
  const auto finished = [&](const CellResult& r) {
    if (r.status == Status::interrupted) {
      ++out.abandoned;
      return;
    }
    keep_estimate(r.cell, keys.key(r.cell, r.metadata ? r.metadata->inputs : no_inputs));
    store.write(r);
    const std::string& method = sweep.methods[r.cell.method].label;
    ++out.done;
    if (has_failure(r)) ++out.failed;
    if (r.status == Status::incomplete) ++out.incomplete;
    for (const Note& note : r.notes) {
      if (note.kind != NoteKind::nondeterministic) continue;
      auto& [first, count] = unsteady[method];
      if (count++ == 0) first = note;
    }
    progress.step(sweep.datasets[r.cell.dataset].label + " / " + method);
  };
  const SandboxOptions sandbox = program_sandbox();
  run_isolated({sweep, resumed.missing, plan.known, plan.root, sandbox},
               arguments.jobs,
               interrupted,
               finished);
  for (const auto& [method, note] : unsteady) {
    const int others = note.second - 1;
    const std::string more = others == 0 ? "" : fmt::format(" (and {} more cells)", others);
    print_error("{}\n", printable(method + ": " + text(note.first) + more));
  }
  return out;
}

/// Prints the results, and writes the tables of a complete sweep. Closes the store.
void tell(const RunPlan& plan, const CellCounts& counts, std::optional<Store>& store) {
  if (plan.shard) {
    store->close();
    fmt::print("shard {}: {} of {} cells done, {} failed\n{}\nnext, with all shards:\n  {}\n",
               plan.shard->name(),
               counts.done,
               plan.planned.size(),
               counts.failed,
               printable(plan.store().string()),
               merge_command(plan.given));
  } else {
    const bool has_tables = plan.has_tables();
    if (has_tables) {
      const std::vector<Record> records =
          all_records(plan.store(), asked_by(plan.sweep.table, plan.sweep.table.where));
      // Methods of an interrupted sweep have different runs: their means are no comparison.
      if (stop_requests == 0) fmt::print("{}", summary_text(plan.store(), records, plan.sweep));
      write_tables(plan.store(), plan.sweep, records, plan.out);
    }
    store->close();
    store.reset();
    const char* const files =
        has_tables ? "{results.sqlite,table.md,table.csv,rows.csv}" : "results.sqlite";
    const std::string no_tables =
        has_tables ? ""
                   : fmt::format("more than {} cells: no tables and summary\n", kMostCellsInTables);
    fmt::print("{}\n{}{}\n{}",
               fitted(status_text(counts, plan.planned.size(), plan.sweep)),
               no_tables,
               printable((plan.out / files).string()),
               next_commands(plan.out));
  }
  if (stop_requests == 0) return;
  print_error(
      "loopbench: interrupted{}; finished cells are kept, the others run next time\n",
      counts.abandoned == 0 ? "" : fmt::format(", {} running cells abandoned", counts.abandoned));
}

/// Returns the exit code. Throws InputError, MissingPart.
int run_config(const RunArguments& arguments, const Source& source) {
  const RunPlan planned = plan(arguments);
  program_sandbox() = sandbox_of_sweep(planned, arguments);  // from here on programs can be started
  if (arguments.dry_run) {
    return dry_run(planned.sweep, planned.planned, planned.known, planned.root);
  }
  require_parts(planned.sweep, planned.planned, planned.known);
  if (!planned.shard && planned.has_tables()) require_writable(table_files(planned.out));
  if (planned.planned.empty() && planned.shard) {
    fmt::print("shard {} has no cells\n", planned.shard->name());
    return kExitOk;
  }
  std::map<std::string, std::string> facts = provenance(source, planned.sweep, planned.known);
  if (uses_programs(planned.sweep)) {
    facts["sandbox"] = is_sandboxed() ? "bubblewrap" : "none";
    const std::string with_network = programs_with_network(planned.sweep);
    const bool is_closed = is_sandboxed() && can_hide_network();
    facts["network"] = is_closed ? with_network : "open to all programs";
    if (facts["network"].empty()) facts["network"] = "none";
  }
  CellKeys keys(planned.sweep, planned.known, planned.root, build_id(source.code));
  std::optional<Store> store(std::in_place, planned.store(), keys, facts, arguments.fresh);
  if (arguments.save_trajectories) set_estimate_folder(planned.out / "trajectories");
  if (planned.shard) {
    store->set_shard(planned.shard->name() + " " + division_hash(planned.selected));
  }
  const CellCounts counts = compute(planned, arguments, keys, *store);
  if (counts.done == 0) return kExitInterrupted;
  tell(planned, counts, store);
  const bool is_failure = counts.failed > 0 && !arguments.failed_cells_ok;
  if (stop_requests > 0) return kExitInterrupted;
  return is_failure ? kExitSomeCellsFailed : kExitOk;
}

}  // namespace

void add_run(CLI::App& app, int& exit_code, const Source& source) {
  auto arguments = std::make_shared<RunArguments>();
  RunArguments& a = *arguments;
  CLI::App& command = *app.add_subcommand("run", "Run the sweep of a config and print a summary");
  declare_config(command, a.config);
  add(command, "--only REGEX", a.only, "Run only cells whose name 'SEQUENCE / METHOD' matches");
  add(command,
      "--shard I/N",
      a.shard,
      "Only this part of N, into its own store OUT/shards/I-of-N; see `merge`");
  command.add_flag("--dry-run",
                   a.dry_run,
                   "Check the config and its input files and list the cells without running them");
  add(command, "-j,--jobs", a.jobs, "Number of workers; does not affect results")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command.add_flag("--save-trajectories",
                   a.save_trajectories,
                   "Save every cell's estimate at full length, see `export --what trajectories`");
  command.add_flag("--failed-cells-ok",
                   a.failed_cells_ok,
                   "Exit with 0 even if cells failed; failures are recorded with their reasons");
  command.add_flag("--no-sandbox", a.no_sandbox, "Let external programs read all files");
  add(command, "--data DIR", a.data, "Folder with real datasets")->envname("LOOPBENCH_DATA");
  add(command, "-o,--out DIR", a.out, "Output folder (default: results/CONFIG)");
  add(command, "--plugin FILE", a.plugins, "Shared object with methods, datasets or metrics")
      ->allow_extra_args(false);
  add(command,
      "--retry",
      a.retry,
      "Stored cells to recompute in addition to damaged ones: failed, or all")
      ->check(CLI::IsMember({"none", "failed", "all"}))
      ->capture_default_str();
  command.add_flag(
      "--fresh", a.fresh, "Recompute all cells; keep the old store as previous-N.sqlite");
  declare_force(command);
  command.callback([arguments, source, &exit_code] { exit_code = run_config(*arguments, source); });
}

}  // namespace loopbench::harness
