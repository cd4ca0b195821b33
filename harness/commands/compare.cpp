#include "harness/compare/compare.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <regex>
#include <utility>

#include "datasets/core/error.hpp"
#include "datasets/formats/regular_file.hpp"
#include "harness/base/print_error.hpp"
#include "harness/base/printable.hpp"
#include "harness/base/write_file.hpp"
#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/looks.hpp"
#include "harness/commands/write_output.hpp"
#include "harness/compare/assertion.hpp"
#include "harness/config/read_claim.hpp"
#include "harness/eval/evo_results.hpp"
#include "harness/model/where.hpp"
#include "harness/store/open.hpp"
#include "harness/store/read.hpp"
#include "harness/tables/all_records.hpp"
#include "harness/tables/claim_store.hpp"
#include "harness/tables/comparison.hpp"

namespace loopbench::harness {
namespace {

const char* const kAssertions =
    "Sentences of --assert about methods A and B, whose values of one score they compare:\n"
    "  A is below B                     significantly lower: p is at most alpha\n"
    "  A is at least X % below B        also, the interval of A / B ends below 1 - X %\n"
    "  A is not above B                 not significantly higher\n"
    "  A is at most X % above B         the interval of A / B ends below 1 + X %\n"
    "  A is not shown to differ from B  neither significantly lower nor higher\n"
    "p and interval are those that `--baseline B` prints. Where too few groups can show nothing, "
    "`not above` and `not shown to differ` hold, too.";

constexpr std::size_t kLongestConfig = 16'000'000;  // [bytes]

struct CompareArguments {
  std::vector<std::string> files;  ///< a store, or result files of evo
  std::string store;
  std::string metric;
  std::vector<std::string> where;
  CompareOptions options;
  std::vector<std::string> assertions;
  std::string as_claim;  ///< file to write
  std::string config;    ///< of the store, for the claim
  OutputOptions output;
};

/// The metric that was asked for, "ate" without any.
std::string metric_of(const CompareArguments& arguments) {
  const auto is_chosen = [](const std::string& rule) {
    return std::regex_search(rule, std::regex("(^|,)(metric|label|score)[=~]"));
  };
  if (!arguments.metric.empty()) return arguments.metric;
  return std::ranges::any_of(arguments.where, is_chosen) ? "" : "ate";
}

std::string comparisons_text(const std::vector<Comparison>& comparisons,
                             const OutputOptions& output) {
  if (output.format() == ExportFormat::csv) return csv(comparisons);
  if (output.format() == ExportFormat::json) return json(comparisons);
  std::vector<Table> tables;
  for (const Comparison& comparison : comparisons) tables.push_back(table_view(comparison));
  return text(tables, output);
}

/// Compares with the method of the first file, if no other is named.
int print_evo_comparison(CompareArguments arguments) {
  std::vector<Record> records = read_evo_results(arguments.files);
  if (arguments.options.baseline.empty()) {
    arguments.options.baseline = records.front().method.text();
  }
  keep_where(records, arguments.where);
  const std::vector<Comparison> comparisons = compare(records, arguments.options);
  write_plain(comparisons_text(comparisons, arguments.output),
              arguments.output,
              {arguments.files.begin(), arguments.files.end()});
  return kExitOk;
}

/// The config that the sweep of a store was made with, relative to the folder of `file`. Throws
/// InputError unless its text is that of the store.
std::string config_beside_claim(const CompareArguments& arguments) {
  const auto run = read_run(arguments.store);
  const std::string path =
      arguments.config.empty() ? "configs/" + run.at("sweep") + ".yaml" : arguments.config;
  std::error_code missing;
  const bool exists = std::filesystem::is_regular_file(path, missing);
  if (!exists || read_named_file(path, kLongestConfig, "config") != run.at("config")) {
    throw InputError(path +
                     (exists ? ": is not the config of " : ": not found; expected the config of ") +
                     arguments.store + "; set --config FILE");
  }
  const std::filesystem::path folder = std::filesystem::absolute(arguments.as_claim).parent_path();
  return std::filesystem::absolute(path).lexically_relative(folder).string();
}

/// Writes the claim that the first method is better than the baseline or, if the baseline is first,
/// than the second; this look is its first.
int write_claim(const CompareArguments& arguments,
                const std::vector<Comparison>& comparisons,
                const Source& source) {
  if (comparisons.size() != 1) {
    throw InputError(fmt::format("--as-claim: expected one score, found {}; select it by --where",
                                 comparisons.size()));
  }
  const Comparison& comparison = comparisons.front();
  if (comparison.methods.size() < 2) throw InputError("--as-claim: " + verdict(comparison));
  const bool leads = comparison.methods.front().method == comparison.options.baseline;
  Claim claim;
  claim.file = arguments.as_claim;
  claim.config = config_beside_claim(arguments);
  claim.method = comparison.methods.front().method;
  claim.baseline = leads ? comparison.methods[1].method : comparison.options.baseline;
  claim.metric = metric_of(arguments);
  claim.where = arguments.where;
  claim.value = arguments.options.value;
  claim.over = arguments.options.over == Over::groups ? "groups" : "sequences";
  claim.alpha = arguments.options.alpha;
  claim.statement = claim.method + " has a smaller error than " + claim.baseline;
  claim.sequences = sequences_of(claim, arguments.store);
  Look look = look_at_store(claim, arguments.store);
  look.date = today();
  look.commit = commit_of(source);
  claim.expected = look.answer;
  claim.looks.push_back(look);
  reject_overwriting({store_file(arguments.store)}, arguments.as_claim);
  write_file(arguments.as_claim, yaml(claim));
  return kExitOk;
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

int print_comparison(CompareArguments arguments, const Source& source) {
  if (is_evo_result(arguments.files.front())) return print_evo_comparison(std::move(arguments));
  arguments.store = one_store(arguments.files);
  const auto compared = [&](const std::string& baseline) {
    CompareOptions options = arguments.options;
    options.baseline = baseline;
    return compare_store(arguments.store, metric_of(arguments), arguments.where, options);
  };
  const std::vector<Comparison> comparisons = compared(arguments.options.baseline);
  if (!arguments.as_claim.empty()) return write_claim(arguments, comparisons, source);
  if (!arguments.assertions.empty()) require_one_score(comparisons);
  const std::vector<std::string> failures =
      not_shown(arguments.assertions, comparisons.front(), [&](const std::string& baseline) {
        return compared(baseline).front();
      });
  write_output(comparisons_text(comparisons, arguments.output),
               arguments.output,
               "comparisons",
               arguments.store);
  for (const std::string& failure : failures) print_error("loopbench: {}\n", printable(failure));
  return failures.empty() ? kExitOk : kExitNotShown;
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code, const Source& source) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command =
      app.add_subcommand("compare", "Compare and rank methods with significance tests");
  command
      ->add_option("store",
                   arguments->files,
                   "Folder of results, its results.sqlite, or result files of evo (zip)")
      ->required();
  command
      ->add_option(
          "--baseline", arguments->options.baseline, "Method that others are compared with")
      ->type_name("METHOD");
  command
      ->add_option(
          "--metric",
          arguments->metric,
          "Label or name of a metric, or a score: ate, error x; ate unless --where selects one")
      ->type_name("METRIC");
  command
      ->add_option("--as-claim",
                   arguments->as_claim,
                   "Write a claim file: the first method against the baseline, this look included; "
                   "see `claim`")
      ->type_name("FILE");
  command
      ->add_option("--config",
                   arguments->config,
                   "With --as-claim: the config of the store (default: configs/SWEEP.yaml)")
      ->type_name("FILE");
  command
      ->add_option("--assert",
                   arguments->assertions,
                   "Sentence that the comparison must show, otherwise exit 1; see below")
      ->type_name("SENTENCE")
      ->allow_extra_args(false);
  command
      ->add_option("--value", arguments->options.value, "Statistic: rmse mean median std min max")
      ->capture_default_str();
  command
      ->add_option("--alpha",
                   arguments->options.alpha,
                   "Significance level; intervals have level 1 - alpha [-]")
      ->check(number_between(1e-6, 0.5))
      ->capture_default_str();
  const std::map<std::string, Over> units{{"groups", Over::groups}, {"sequences", Over::sequences}};
  command
      ->add_option("--over",
                   arguments->options.over,
                   "Unit of independent observations: groups of dependent runs, or sequences")
      ->transform(one_of("observation", units));
  declare_ties(*command, arguments->options.tie, arguments->options.relevant);
  command->add_flag(
      "--paired",
      arguments->options.paired,
      "Also pair runs of evaluated files, by their names; those of sweeps always are");
  command->add_option(
      "--where", arguments->where, "Filter of rows: FIELD=TEXT, FIELD!=TEXT, FIELD~REGEX, ...");
  declare(*command,
          arguments->output,
          {ExportFormat::markdown,
           ExportFormat::terminal,
           ExportFormat::latex,
           ExportFormat::csv,
           ExportFormat::json});
  command->footer(kAssertions);
  command->callback(
      [arguments, source, &exit_code] { exit_code = print_comparison(*arguments, source); });
}

}  // namespace loopbench::harness
