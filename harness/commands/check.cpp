#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "datasets/core/error.hpp"
#include "harness/commands/commands.hpp"
#include "harness/export/gate.hpp"
#include "harness/export/write_file.hpp"
#include "harness/gate/snapshot.hpp"

namespace loopbench {
namespace {

struct CheckArguments {
  std::string store;
  std::string baseline;
  std::string junit;
  std::string markdown;
  bool update = false;
};

/// Limits are a person's decision: an update keeps them.
int update(const CheckArguments& arguments) {
  Baseline baseline;
  if (std::filesystem::exists(arguments.baseline)) {
    baseline.limits = read_baseline(arguments.baseline).limits;
  }
  baseline.snapshot = snapshot(arguments.store, baseline.limits);
  baseline.made_by = made_by(arguments.store);
  write_file(arguments.baseline, json(baseline));
  fmt::print("{}: {} cells written\n", arguments.baseline, baseline.snapshot.cells.size());
  return kExitOk;
}

int check_store(const CheckArguments& arguments) {
  if (arguments.update) return update(arguments);
  const Baseline baseline = read_baseline(arguments.baseline);
  const Snapshot now = snapshot(arguments.store, baseline.limits);
  GateReport report;
  try {
    report = check(baseline, now);
  } catch (const InputError& error) {
    throw InputError(arguments.baseline + ": " + error.what());
  }
  const std::string text = markdown(report, baseline.snapshot.sweep);
  if (!arguments.markdown.empty()) write_file(arguments.markdown, text);
  if (!arguments.junit.empty()) write_file(arguments.junit, junit(report, baseline.snapshot.sweep));
  fmt::print("{}", text);
  return report.passes() ? kExitOk : kExitRegression;
}

}  // namespace

void add_check(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<CheckArguments>();
  CLI::App* command = app.add_subcommand("check", "Is a sweep still as good as its baseline");
  command->add_option("store", arguments->store, "Folder of results, or its results.sqlite")
      ->required();
  command
      ->add_option("--baseline", arguments->baseline, "Such as results/reference/quickstart.json")
      ->required()
      ->type_name("FILE");
  command->add_option("--junit", arguments->junit, "Write JUnit XML too")->type_name("FILE");
  command->add_option("--markdown", arguments->markdown, "Write the report too")->type_name("FILE");
  command->add_flag(
      "--update", arguments->update, "Write the baseline from this store; its limits are kept");
  command->footer("Exit codes: 0 passes, 1 regression, 2 unusable input, 3 internal error.");
  command->callback([arguments, &exit_code] { exit_code = check_store(*arguments); });
}

}  // namespace loopbench
