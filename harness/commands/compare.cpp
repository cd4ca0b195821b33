#include <CLI/CLI.hpp>

#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/write_output.hpp"
#include "harness/tables/all_records.hpp"
#include "harness/tables/comparison.hpp"
#include "harness/tables/text.hpp"

namespace loopbench::harness {
namespace {

struct CompareArguments {
  std::string store;
  std::string metric = "ate";
  std::vector<std::string> where;
  CompareOptions options;
  OutputOptions output;
};

int print_comparison(const CompareArguments& arguments) {
  std::future<StoreProvenance> provenance = begin_provenance(arguments.store);
  const std::vector<Comparison> comparisons =
      compare_store(arguments.store, arguments.metric, arguments.where, arguments.options);
  write_output(text_of(comparisons, arguments.output),
               arguments.output,
               "comparisons",
               std::move(provenance),
               arguments.store);
  return kExitOk;
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command =
      app.add_subcommand("compare", "Compare and rank methods with significance tests");
  command->add_option("store", arguments->store, "Folder of results, or its results.sqlite")
      ->required();
  command
      ->add_option(
          "--baseline", arguments->options.baseline, "Method that others are compared with")
      ->type_name("METHOD");
  command
      ->add_option(
          "--metric", arguments->metric, "Label or name of a metric, or a score: ate, error x")
      ->capture_default_str();
  command
      ->add_option("--value", arguments->options.value, "Statistic: rmse mean median std min max")
      ->capture_default_str();
  command
      ->add_option("--alpha",
                   arguments->options.alpha,
                   "Significance level; intervals have level 1 - alpha [-]")
      ->check(finite_number())
      ->check(CLI::Range(1e-6, 0.5))
      ->capture_default_str();
  const std::map<std::string, Over> units{
      {"groups", Over::groups}, {"runs", Over::runs}, {"sequences", Over::sequences}};
  command
      ->add_option("--over",
                   arguments->options.over,
                   "Unit of independent observations: groups of runs, single runs, or sequences")
      ->transform(one_of("observation", units));
  command
      ->add_option(
          "--tie", arguments->options.tie, "Largest relative difference that counts as a tie [-]")
      ->check(finite_number())
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  command
      ->add_option("--relevant",
                   arguments->options.relevant,
                   "Relative difference below which methods share the first place [-]")
      ->check(finite_number())
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  command->add_option(
      "--where", arguments->where, "Filter of rows: FIELD=TEXT, FIELD!=TEXT, FIELD~REGEX, ...");
  declare(*command,
          arguments->output,
          {ExportFormat::markdown,
           ExportFormat::terminal,
           ExportFormat::latex,
           ExportFormat::csv,
           ExportFormat::json});
  command->callback([arguments, &exit_code] { exit_code = print_comparison(*arguments); });
}

}  // namespace loopbench::harness
