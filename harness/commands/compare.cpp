#include <CLI/CLI.hpp>

#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/deliver.hpp"
#include "harness/commands/tables.hpp"
#include "harness/export/comparison.hpp"
#include "harness/export/text.hpp"

namespace loopbench {
namespace {

struct CompareArguments {
  std::string store;
  std::string metric = "ate";
  std::vector<std::string> where;
  CompareOptions options;
  ExportFormat format = ExportFormat::markdown;
  std::string out;
};

std::string text(const std::vector<Comparison>& comparisons, ExportFormat format) {
  if (format == ExportFormat::csv) return csv(comparisons);
  if (format == ExportFormat::json) return json(comparisons);
  std::string out;
  for (const Comparison& comparison : comparisons) {
    const Sheet shown = sheet(comparison);
    out += out.empty() ? "" : "\n";
    out += format == ExportFormat::latex      ? latex(shown)
           : format == ExportFormat::terminal ? terminal(shown)
                                              : markdown(shown);
  }
  return out;
}

int print_comparison(const CompareArguments& arguments) {
  const std::vector<Comparison> comparisons =
      compare_store(arguments.store, arguments.metric, arguments.where, arguments.options);
  deliver(text(comparisons, arguments.format),
          arguments.format,
          "comparisons",
          arguments.store,
          arguments.out);
  return kExitOk;
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command =
      app.add_subcommand("compare", "Which method is best, and is the difference real");
  command->add_option("store", arguments->store, "Folder of results, or its results.sqlite")
      ->required();
  command
      ->add_option("--baseline", arguments->options.baseline, "Method that others are set against")
      ->type_name("METHOD");
  command
      ->add_option(
          "--metric", arguments->metric, "label or name of a metric, or a score: ate, error x")
      ->capture_default_str();
  command->add_option("--value", arguments->options.value, "rmse mean median std min max sse count")
      ->capture_default_str();
  command
      ->add_option("--alpha",
                   arguments->options.alpha,
                   "Chance of a false claim; 1 - alpha is the level of intervals")
      ->check(finite_number())
      ->check(CLI::Range(1e-6, 0.5))
      ->capture_default_str();
  const std::map<std::string, Over> units{
      {"groups", Over::groups}, {"runs", Over::runs}, {"sequences", Over::sequences}};
  command
      ->add_option("--over",
                   arguments->options.over,
                   "Independent observations: groups of runs, every run, or sequences")
      ->transform(one_of("observation", units));
  command
      ->add_option("--relevant",
                   arguments->options.relevant,
                   "Largest relative difference that counts as a tie [-]")
      ->check(finite_number())
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  command->add_option("--where", arguments->where, "FIELD=TEXT, FIELD!=TEXT, FIELD~REGEX, ...");
  const std::map<std::string, ExportFormat> formats{{"markdown", ExportFormat::markdown},
                                                    {"terminal", ExportFormat::terminal},
                                                    {"latex", ExportFormat::latex},
                                                    {"csv", ExportFormat::csv},
                                                    {"json", ExportFormat::json}};
  command->add_option("--format", arguments->format, "How to print")
      ->transform(one_of("format", formats));
  command
      ->add_option("-o,--out",
                   arguments->out,
                   "Write a file (-: standard output); beside a CSV, its provenance")
      ->type_name("FILE");
  command->callback([arguments, &exit_code] { exit_code = print_comparison(*arguments); });
}

}  // namespace loopbench
