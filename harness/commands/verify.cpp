#include "harness/execution/verify/verify.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>

#include "harness/catalogue/load_sequence.hpp"
#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/config_path.hpp"
#include "harness/commands/interruption.hpp"
#include "harness/config/data_root.hpp"
#include "harness/config/read_sweep.hpp"
#include "harness/execution/run/progress.hpp"
#include "harness/provenance/build.hpp"
#include "harness/shards/stored_sample.hpp"
#include "harness/text/printable.hpp"

namespace loopbench::harness {
namespace {

struct VerifyArguments {
  std::string config;
  std::string only;
  std::string data;
  std::vector<std::filesystem::path> plugins;
  SampleArguments sample;
};

int verify_sample(const SweepSetting& setting, const SampleArguments& arguments) {
  const StopRequests& interrupted = install_interrupt_handler();
  std::optional<Progress> progress;
  const RecomputedSample sample = recompute_sample(
      setting, arguments, interrupted, [&](std::size_t cells, const std::string& label) {
        if (!progress) progress.emplace(cells);
        progress->step(label);
      });
  progress.reset();
  if (interrupted > 0) return kExitInterrupted;
  for (const CellDifference& difference : sample.differences) {
    fmt::print(
        "{}: {} differs from the stored result\n", printable(difference.label), difference.part);
  }
  fmt::print("{} stored cells recomputed: {}\n",
             sample.cells,
             sample.differences.empty() ? "bit-identical"
                                        : fmt::format("{} differ", sample.differences.size()));
  return sample.differences.empty() ? kExitOk : kExitSomeCellsFailed;
}

int run_verify(const VerifyArguments& arguments, const Source& source) {
  const Catalogue known =
      catalogue(with_config_plugins(arguments.plugins, config_path(arguments.config)));
  Sweep sweep = read_sweep(config_path(arguments.config), known, arguments.data);
  if (arguments.sample.share > 0.0) {
    SampleArguments sample = arguments.sample;
    sample.only = arguments.only;
    if (sample.store.empty()) sample.store = "results/" + sweep.name;
    const DataRoot root = data_root(sweep, arguments.data);
    return verify_sample({sweep, known, root, build_id(source.code)}, sample);
  }
  sweep.timing = 1;  // times are not compared
  sweep.serial = false;
  sweep.traces = true;
  const DataRoot root = data_root(sweep, arguments.data);
  const std::vector<Cell> planned = cells(sweep, seeded(sweep, known), arguments.only);
  if (planned.empty()) throw InputError(arguments.config + ": no cells to run");
  // The first setting runs twice, because a method alone can differ from run to run.
  const std::vector<RunMode> modes{
      {true, 1}, {true, 1}, {true, 2}, {true, 5}, {false, 1}, {false, 4}};
  const StopRequests& interrupted = install_interrupt_handler();
  SandboxOptions sandbox;
  if (!arguments.data.empty()) sandbox.hidden.emplace_back(arguments.data);
  std::vector<Difference> found;
  {
    Progress progress(planned.size() * modes.size());
    found = verify(
        sweep, planned, known, root, modes, sandbox, interrupted, [&](const std::string& label) {
          progress.step(label);
        });
  }
  if (interrupted > 0) return kExitInterrupted;
  for (const Difference& difference : found) {
    const Cell& cell = planned[difference.cell];
    fmt::print("{} / {}{}: {} differs between {} and {}\n",
               printable(sweep.datasets[cell.dataset].label),
               printable(sweep.methods[cell.method].label),
               cell.repeat > 0 ? fmt::format(" (repeat {})", cell.repeat) : "",
               difference.part,
               difference.mode,
               modes.front().name());
  }
  std::string names;
  for (const RunMode& mode : modes) names += (names.empty() ? "" : ", ") + mode.name();
  fmt::print("{} cells run with {}: {}\n",
             planned.size(),
             names,
             found.empty() ? "bit-identical" : fmt::format("{} differences", found.size()));
  return found.empty() ? kExitOk : kExitSomeCellsFailed;
}

}  // namespace

void add_verify(CLI::App& app, int& exit_code, const Source& source) {
  auto arguments = std::make_shared<VerifyArguments>();
  CLI::App* command = app.add_subcommand(
      "verify",
      "Check that results are bit-identical for any number of workers or, with --sample, to those "
      "of a store");
  command
      ->add_option(
          "config", arguments->config, "YAML file, or the name of an installed config: quickstart")
      ->required();
  command->add_option("--only", arguments->only, "Only cells whose 'SEQUENCE / METHOD' matches")
      ->type_name("REGEX");
  command->add_option("--data", arguments->data, "Folder with real datasets")
      ->envname("LOOPBENCH_DATA")
      ->type_name("DIR");
  command
      ->add_option(
          "--sample",
          arguments->sample.share,
          "Recompute this fraction of the cells of a store and compare them bit by bit [-]")
      ->check(finite_number())
      ->check(CLI::Range(0.0, 1.0));
  command
      ->add_option("--store",
                   arguments->sample.store,
                   "With --sample: folder of results (default: results/CONFIG)")
      ->type_name("DIR");
  command->add_option("-j,--jobs", arguments->sample.jobs, "With --sample: number of workers")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command
      ->add_option(
          "--plugin", arguments->plugins, "Shared object with methods, datasets or metrics")
      ->type_name("FILE");
  command->callback(
      [arguments, source, &exit_code] { exit_code = run_verify(*arguments, source); });
}

}  // namespace loopbench::harness
