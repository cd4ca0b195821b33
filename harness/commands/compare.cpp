#include <CLI/CLI.hpp>
#include <optional>

#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/commands/write_output.hpp"
#include "harness/tables/all_records.hpp"
#include "harness/tables/comparison.hpp"
#include "harness/tables/text.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {
namespace {

struct CompareArguments {
  std::string store;
  std::string metric = "ate";
  std::vector<std::string> where;
  CompareOptions options;
  std::optional<ExportFormat> format;  ///< none: terminal on a terminal, otherwise Markdown
  std::string out;
};

std::string text(const std::vector<Comparison>& comparisons,
                 ExportFormat format,
                 const TerminalStyle& style) {
  if (format == ExportFormat::csv) return csv(comparisons);
  if (format == ExportFormat::json) return json(comparisons);
  std::string out;
  for (const Comparison& comparison : comparisons) {
    const TableView shown = table_view(comparison);
    out += out.empty() ? "" : "\n";
    out += format == ExportFormat::latex      ? latex(shown)
           : format == ExportFormat::terminal ? terminal(shown, style)
                                              : markdown(shown);
  }
  return out;
}

int print_comparison(const CompareArguments& arguments) {
  std::future<StoreProvenance> provenance = begin_provenance(arguments.store);
  const std::vector<Comparison> comparisons =
      compare_store(arguments.store, arguments.metric, arguments.where, arguments.options);
  const bool is_printed = arguments.out.empty() || is_dash(arguments.out);
  const bool has_terminal = is_printed && prints_to_terminal();
  const ExportFormat format =
      arguments.format.value_or(has_terminal ? ExportFormat::terminal : ExportFormat::markdown);
  const TerminalStyle style = is_printed ? standard_output_style() : TerminalStyle{};
  write_output(text(comparisons, format, style),
               format,
               "comparisons",
               std::move(provenance),
               arguments.store,
               arguments.out);
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
      ->add_option("--relevant",
                   arguments->options.relevant,
                   "Largest relative difference that counts as a tie [-]")
      ->check(finite_number())
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  command->add_option(
      "--where", arguments->where, "Filter of rows: FIELD=TEXT, FIELD!=TEXT, FIELD~REGEX, ...");
  const std::map<std::string, ExportFormat> formats{{"markdown", ExportFormat::markdown},
                                                    {"terminal", ExportFormat::terminal},
                                                    {"latex", ExportFormat::latex},
                                                    {"csv", ExportFormat::csv},
                                                    {"json", ExportFormat::json}};
  command
      ->add_option("--format",
                   arguments->format,
                   "Output format; default: terminal on a terminal, otherwise markdown")
      ->transform(one_of("format", formats));
  command
      ->add_option("-o,--out",
                   arguments->out,
                   "File to write (-: standard output); for CSV also its provenance")
      ->type_name("FILE");
  command->callback([arguments, &exit_code] { exit_code = print_comparison(*arguments); });
}

}  // namespace loopbench::harness
