#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "harness/commands/commands.hpp"
#include "harness/commands/tables.hpp"
#include "harness/config/read_sweep.hpp"
#include "harness/export/text.hpp"

namespace loopbench {
namespace {

enum class TableFormat { markdown, csv, rows };

struct TableArguments {
  std::string store;
  std::vector<std::string> where;
  TableSpec spec;
  TableFormat format = TableFormat::markdown;
};

/// Keeps records whose named column has the given text: `metric=ate`.
void filter(std::vector<Record>& records, const std::string& rule) {
  const std::size_t equals = rule.find('=');
  if (equals == std::string::npos) {
    throw InputError("--where: '" + rule + "' is not COLUMN=TEXT, for example metric=ate");
  }
  const std::string name = rule.substr(0, equals);
  const std::string text = rule.substr(equals + 1);
  std::erase_if(records, [&](const Record& r) {
    // Declined and failed cells have no metric, but their reasons belong into every table.
    return field(r, name) != text && !(r.metric.empty() && field(r, name).empty());
  });
}

int print_table(const TableArguments& arguments) {
  std::vector<Record> records = all_records(arguments.store);
  for (const std::string& rule : arguments.where) filter(records, rule);
  if (records.empty()) throw InputError(arguments.store + ": no row matches --where");
  if (arguments.format == TableFormat::rows) {
    fmt::print("{}", csv(records));
    return kExitOk;
  }
  const std::vector<Table> tables = pivot(records, arguments.spec);
  fmt::print("{}", arguments.format == TableFormat::csv ? csv(tables) : markdown(tables));
  return kExitOk;
}

}  // namespace

void add_table(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<TableArguments>();
  CLI::App* command = app.add_subcommand("table", "Tables from the results of a sweep");
  command->add_option("store", arguments->store, "Folder of results, or its results.sqlite")
      ->required();
  const std::string columns = "comma-separated columns of the long table";
  command->add_option("--rows", arguments->spec.rows, "Rows: " + columns)
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--columns", arguments->spec.columns, "Columns: " + columns)
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--split", arguments->spec.split, "One table for each: " + columns)
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--value", arguments->spec.value, "rmse mean median std min max sse count")
      ->capture_default_str();
  command->add_option("--show", arguments->spec.show, "Only these scores: ate,error x,gain,time")
      ->delimiter(',');
  command->add_option("--where", arguments->where, "Keep rows with this text: COLUMN=TEXT");
  const std::map<std::string, TableFormat> formats{
      {"markdown", TableFormat::markdown}, {"csv", TableFormat::csv}, {"rows", TableFormat::rows}};
  command->add_option("--format", arguments->format, "markdown, csv, or rows (the long table)")
      ->transform(CLI::CheckedTransformer(formats).description("markdown|csv|rows"));
  command->callback([arguments, &exit_code] { exit_code = print_table(*arguments); });
}

}  // namespace loopbench
