#include <CLI/CLI.hpp>
#include <optional>

#include "datasets/core/error.hpp"
#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/commands/write_output.hpp"
#include "harness/model/where.hpp"
#include "harness/tables/all_records.hpp"
#include "harness/tables/store_tables.hpp"
#include "harness/tables/text.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {
namespace {

enum class TableFormat { markdown, terminal, latex, csv, json, rows };

struct TableArguments {
  std::string store;
  TableSpec spec;
  std::vector<std::string> where;
  RankingOptions ranking;
  std::optional<TableFormat> format;  ///< none: terminal on a terminal, otherwise Markdown
  std::string out;
};

std::string text(const std::vector<Table>& tables, TableFormat format, const TerminalStyle& style) {
  if (format == TableFormat::csv) return csv(tables);
  if (format == TableFormat::json) return json(tables);
  if (format == TableFormat::markdown) return markdown(tables);
  std::string out;
  for (const Table& table : tables) {
    const TableView shown = table_view(table);
    out += out.empty() ? "" : "\n";
    out += format == TableFormat::latex ? latex(shown) : terminal(shown, style);
  }
  return out;
}

ExportFormat container_format(TableFormat format) {
  switch (format) {
    case TableFormat::terminal:
      return ExportFormat::terminal;
    case TableFormat::latex:
      return ExportFormat::latex;
    case TableFormat::csv:
    case TableFormat::rows:
      return ExportFormat::csv;
    case TableFormat::json:
      return ExportFormat::json;
    case TableFormat::markdown:
      break;
  }
  return ExportFormat::markdown;
}

int print_table(TableArguments arguments) {
  std::future<StoreProvenance> provenance = begin_provenance(arguments.store);
  const bool is_printed = arguments.out.empty() || is_dash(arguments.out);
  const TerminalStyle style = is_printed ? standard_output_style() : TerminalStyle{};
  const bool has_terminal = is_printed && prints_to_terminal();
  const TableFormat format =
      arguments.format.value_or(has_terminal ? TableFormat::terminal : TableFormat::markdown);
  std::vector<std::string> show;
  for (const std::string& word : arguments.spec.show) {
    for (std::string& score : split_list(word)) show.push_back(std::move(score));
  }
  arguments.spec.show = std::move(show);
  std::string shown;
  if (format == TableFormat::rows) {
    std::vector<Record> records = all_records(arguments.store);
    keep_where(records, arguments.where);
    if (records.empty()) {
      throw InputError(arguments.store +
                       (arguments.where.empty() ? ": has no rows" : ": no row matches --where"));
    }
    shown = csv(records);
  } else {
    shown = text(store_tables(arguments.store, arguments.where, arguments.spec, arguments.ranking),
                 format,
                 style);
  }
  write_output(shown,
               container_format(format),
               "tables",
               std::move(provenance),
               arguments.store,
               arguments.out);
  return kExitOk;
}

}  // namespace

void add_table(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<TableArguments>();
  CLI::App* command = app.add_subcommand("table", "Print tables of a sweep's results");
  command->add_option("store", arguments->store, "Folder of results, or its results.sqlite")
      ->required();
  const std::string columns =
      "comma-separated fields (sequence, repeat, method, closures, protocol, times, metric, label, "
      "relation, axis, unit, status, score)";
  command
      ->add_option(
          "--rows", arguments->spec.rows, "Rows: " + columns + "; sequence: sequences by methods")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--columns", arguments->spec.columns, "Columns: " + columns)
      ->delimiter(',')
      ->capture_default_str();
  command
      ->add_option(
          "--split", arguments->spec.split, "One table for each: " + columns + "; '': one table")
      ->delimiter(',')
      ->capture_default_str();
  command
      ->add_option(
          "--value", arguments->spec.value, "Statistic: rmse mean median std min max sse count")
      ->capture_default_str();
  command->add_flag("--plus-minus",
                    arguments->spec.plus_minus,
                    "Add the standard deviation over the averaged cells to each number");
  command->add_option("--show", arguments->spec.show, "Scores to show: ate,error x,gain,time");
  command->add_option("--where",
                      arguments->where,
                      "Filter of rows: FIELD=TEXT, FIELD!=TEXT, FIELD~REGEX, comma-separated; "
                      "FIELD=\"TEXT\" if TEXT contains commas");
  command
      ->add_option(
          "--alpha", arguments->ranking.alpha, "Significance level of the marks in a column [-]")
      ->check(finite_number())
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  command
      ->add_option("--relevant",
                   arguments->ranking.relevant,
                   "Largest relative difference that counts as a tie [-]")
      ->check(finite_number())
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  const std::map<std::string, TableFormat> formats{{"markdown", TableFormat::markdown},
                                                   {"terminal", TableFormat::terminal},
                                                   {"latex", TableFormat::latex},
                                                   {"csv", TableFormat::csv},
                                                   {"json", TableFormat::json},
                                                   {"rows", TableFormat::rows}};
  command
      ->add_option("--format",
                   arguments->format,
                   "Output format; rows is the long table. Default: terminal on a terminal, "
                   "otherwise markdown")
      ->transform(one_of("format", formats));
  command
      ->add_option("-o,--out",
                   arguments->out,
                   "File to write (-: standard output); for CSV also its provenance")
      ->type_name("FILE");
  command->callback([arguments, &exit_code] { exit_code = print_table(*arguments); });
}

}  // namespace loopbench::harness
