#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "harness/commands/commands.hpp"
#include "harness/commands/eval_options.hpp"
#include "harness/eval/evaluate_files.hpp"
#include "harness/text/printable.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {
namespace {

int eval(const EvalArguments& a) {
  if (a.estimates.empty() && !std::filesystem::is_directory(a.reference)) {
    throw CLI::RequiredError("EST");
  }
  std::vector<EvaluationResult> all = evaluate_files(a);
  if (!a.min_coverage) compare_coverage(all);
  if (!a.per_pose.empty()) write_file(a.per_pose, pose_csv(all));
  if (a.json) {
    fmt::print("{}", json(all));
  } else if (a.csv) {
    fmt::print("{}", csv(all));
  } else {
    fmt::print("{}", printable(all.size() == 1 ? text(all.front()) : comparison(all)));
  }
  const bool all_ok = std::ranges::all_of(
      all, [](const EvaluationResult& result) { return status(result) == "ok"; });
  return all_ok ? kExitOk : kExitSomeCellsFailed;
}

}  // namespace

void add_eval(CLI::App& app, int& exit_code) {
  auto a = std::make_shared<EvalArguments>();
  CLI::App* command = app.add_subcommand("eval", "Evaluate trajectory files against a reference");
  declare(*command, *a);
  command->callback([a, &exit_code] { exit_code = eval(*a); });
}

}  // namespace loopbench::harness
