#include "harness/answers/compare/compare.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <optional>

#include "datasets/core/error.hpp"
#include "harness/answers/compare/assertion.hpp"
#include "harness/answers/tables/comparison.hpp"
#include "harness/answers/tables/store_tables.hpp"
#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/write_output.hpp"
#include "harness/sweep/catalogue/scratch.hpp"
#include "harness/sweep/store/merge.hpp"
#include "harness/sweep/text/pattern.hpp"
#include "harness/sweep/text/print_error.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {
namespace {

const char* const kAssertions =
    "--assert takes one of these sentences about the values of one score of methods A and B:\n"
    "  A is below B                     significantly lower: p is at most alpha\n"
    "  A is at least X % below B        the same, and the upper end of the interval of the change "
    "is at most -X %\n"
    "  A is not above B                 not significantly higher\n"
    "  A is at most X % above B         the upper end of the interval of the change is at most X "
    "%\n"
    "  A is not shown to differ from B  neither significantly lower nor higher\n"
    "p, the change from B to A and its interval are those that `--baseline B` prints. With too few "
    "groups to show anything, `not above` and `not shown to differ` also hold.";

struct CompareArguments {
  std::vector<std::filesystem::path> stores;
  std::string metric;
  std::vector<std::string> where;
  CompareOptions options;
  std::vector<std::string> assertions;
  OutputOptions output;
};

/// The metric that was asked for, "ate" without any.
std::string metric_of(const CompareArguments& arguments) {
  const auto is_chosen = [](const std::string& rule) {
    return Pattern("(^|,)(metric|label|score)[=~]").matches_part(rule);
  };
  if (!arguments.metric.empty()) return arguments.metric;
  return std::ranges::any_of(arguments.where, is_chosen) ? "" : "ate";
}

std::string comparisons_text(const std::vector<Comparison>& comparisons,
                             const OutputOptions& output,
                             const std::string& store,
                             const std::vector<std::string>& rules) {
  if (output.format() == ExportFormat::csv) return csv(comparisons);
  if (output.format() == ExportFormat::json) return json(comparisons);
  return text(answer(comparisons), output, store, rules);
}

/// Assertions are about one score.
void require_one_score(const std::vector<Comparison>& comparisons) {
  if (comparisons.size() == 1) return;
  std::string titles;
  for (const Comparison& c : comparisons) titles += (titles.empty() ? "" : "; ") + title(c);
  throw InputError(
      fmt::format("--assert: expected one score, found {}: {}; choose one by --metric and --where, "
                  "for example --where times=dense,unit=m",
                  comparisons.size(),
                  titles));
}

int print_comparison(const CompareArguments& arguments) {
  std::string store = arguments.stores.front().string();
  std::optional<NewFolder> merged;
  if (arguments.stores.size() > 1) {
    merged.emplace("loopbench-compare-");
    store = (merged->path() / "all" / "results.sqlite").string();  // its folder will be locked
    merge_stores(arguments.stores, store, {.mixed_builds = true});
  }
  const auto compared = [&](const std::string& baseline) {
    CompareOptions options = arguments.options;
    options.baseline = baseline;
    return compare_store(store, metric_of(arguments), arguments.where, options);
  };
  const std::vector<Comparison> comparisons = compared(arguments.options.baseline);
  if (!arguments.assertions.empty()) require_one_score(comparisons);
  const std::vector<std::string> failures =
      not_shown(arguments.assertions, comparisons.front(), [&](const std::string& baseline) {
        return compared(baseline).front();
      });
  write_output(comparisons_text(comparisons, arguments.output, store, arguments.where),
               arguments.output,
               "comparisons",
               store);
  for (const std::string& failure : failures) print_error("loopbench: {}\n", printable(failure));
  return failures.empty() ? kExitOk : kExitNotShown;
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<CompareArguments>();
  CompareArguments& a = *arguments;
  CLI::App& command =
      *app.add_subcommand("compare", "Compare and rank methods with significance tests");
  reads(command,
        add(command,
            "store",
            a.stores,
            "Folders of results, or their results.sqlite; several are compared as one"))
      ->required()
      ->expected(1, -1);
  add(command, "--baseline METHOD", a.options.baseline, "Method that others are compared with");
  add(command,
      "--metric METRIC",
      a.metric,
      "Metric or score, by label or name: ate, error x, cpu; ate unless --where selects one");
  add(command,
      "--assert SENTENCE",
      a.assertions,
      "Sentence that the results must support; otherwise exit with 1. See below")
      ->allow_extra_args(false);
  add(command,
      "--value",
      a.options.value,
      fmt::format("Statistic: {}", fmt::join(directed_statistics(), " ")))
      ->capture_default_str();
  add(command, "--alpha", a.options.alpha, "Significance level; intervals have level 1 - alpha [-]")
      ->check(number_between(1e-6, 0.5))
      ->capture_default_str();
  const std::map<std::string, Over> units{{"groups", Over::groups}, {"sequences", Over::sequences}};
  command
      .add_option(
          "--over", a.options.over, "Unit of observation: groups of dependent runs, or sequences")
      ->transform(one_of("observation", units));
  const auto share = [&](const char* name, double& value, const char* help) {
    command.add_option(name, value, help)->check(number_between(0.0, 0.5))->capture_default_str();
  };
  share("--tie", a.options.tie, "Largest relative difference that counts as a tie [-]");
  share("--relevant",
        a.options.relevant,
        "Relative difference below which methods share the first place [-]");
  command.add_flag("--paired",
                   a.options.paired,
                   "Pair runs of evaluated files by name, too; runs of sweeps are always paired");
  add(command, "--where", a.where, "Filter of rows: FIELD=TEXT, FIELD!=TEXT, FIELD~REGEX, ...");
  declare(command, a.output);
  command.footer(kAssertions);
  command.callback([arguments, &exit_code] { exit_code = print_comparison(*arguments); });
}

}  // namespace loopbench::harness
