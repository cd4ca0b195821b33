#include "harness/profile/profile.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>

#include "datasets/core/error.hpp"
#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/commands/write_output.hpp"
#include "harness/store/read.hpp"
#include "harness/store/record_reader.hpp"
#include "harness/text/pattern.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {
namespace {

struct ProfileArguments {
  std::string store;
  std::string only;
  std::optional<ExportFormat> format;  ///< none: terminal on a terminal, otherwise Markdown
  std::string out;
  Accuracy accuracy;
  bool has_accuracy = false;  ///< an option names it, so that it must be there
};

int print_profile(const ProfileArguments& arguments) {
  std::future<StoreProvenance> provenance = begin_provenance(arguments.store);
  const Pattern selected = Pattern::of_option("--only", arguments.only);
  std::vector<CellRecord> cells = read_costs(arguments.store);
  std::erase_if(cells, [&](const CellRecord& cell) {
    return !selected.is_in(cell.sequence + " / " + cell.method);
  });
  if (cells.empty()) throw InputError(arguments.store + ": no cell matches --only");
  value(Record{}, arguments.accuracy.value);  // throws for an unknown name before printing
  const bool is_printed = arguments.out.empty() || is_dash(arguments.out);
  const bool has_terminal = is_printed && prints_to_terminal();
  const ExportFormat format =
      arguments.format.value_or(has_terminal ? ExportFormat::terminal : ExportFormat::markdown);
  const TerminalStyle style = is_printed ? standard_output_style() : TerminalStyle{};
  RecordReader reader(arguments.store);
  const RecordSource records = [&](const auto& visit) { reader.for_each(visit); };
  const TableView accuracies = pareto(cells, records, arguments.accuracy);
  if (arguments.has_accuracy && accuracies.lines.empty()) {
    throw InputError(arguments.store + ": " + accuracies.notes.front());
  }
  std::string out;
  for (const TableView& listing : {costs(cells), reported(cells), scaling(cells), accuracies}) {
    out += out.empty() ? "" : "\n";
    out += format == ExportFormat::csv        ? csv(listing)
           : format == ExportFormat::terminal ? terminal(listing, style)
                                              : markdown(listing);
  }
  write_output(out, format, "profile", std::move(provenance), arguments.store, arguments.out);
  return kExitOk;
}

}  // namespace

void add_profile(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ProfileArguments>();
  CLI::App* command = app.add_subcommand(
      "profile", "Report run time, memory, scaling with size, and accuracy against time");
  command->add_option("store", arguments->store, "Folder of results, or its results.sqlite")
      ->required();
  command->add_option("--only", arguments->only, "Only cells whose 'SEQUENCE / METHOD' matches")
      ->type_name("REGEX");
  command
      ->add_option(
          "--metric", arguments->accuracy.metric, "Metric used as accuracy, by label or name")
      ->capture_default_str();
  command->add_option("--relation", arguments->accuracy.relation, "Relation of the metric's score")
      ->capture_default_str();
  command->add_option("--axis", arguments->accuracy.axis, "Axis of the metric's score")
      ->capture_default_str();
  command
      ->add_option("--value", arguments->accuracy.value, "Statistic: rmse mean median std min max")
      ->capture_default_str();
  const std::map<std::string, ExportFormat> formats{{"markdown", ExportFormat::markdown},
                                                    {"terminal", ExportFormat::terminal},
                                                    {"csv", ExportFormat::csv}};
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
  command->callback([arguments, command, &exit_code] {
    for (const char* option : {"--metric", "--relation", "--axis"}) {
      if (command->count(option) > 0) arguments->has_accuracy = true;
    }
    exit_code = print_profile(*arguments);
  });
}

}  // namespace loopbench::harness
