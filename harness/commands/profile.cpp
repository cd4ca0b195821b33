#include "harness/profile/profile.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "datasets/core/error.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/write_output.hpp"
#include "harness/store/read.hpp"
#include "harness/store/record_reader.hpp"
#include "harness/text/pattern.hpp"

namespace loopbench::harness {
namespace {

struct ProfileArguments {
  std::string store;
  std::string only;
  OutputOptions output;
  Accuracy accuracy;
  bool has_accuracy = false;  ///< an option names it, so that it must be there
};

int print_profile(const ProfileArguments& arguments) {
  std::future<StoreProvenance> provenance = begin_provenance(arguments.store);
  const Pattern selected = Pattern::of_option("--only", arguments.only);
  std::vector<CellRecord> cells = read_cells(arguments.store);
  std::erase_if(cells, [&](const CellRecord& cell) {
    return !selected.is_in(cell.sequence + " / " + cell.method);
  });
  if (cells.empty()) throw InputError(arguments.store + ": no cell matches --only");
  value(Record{}, arguments.accuracy.value);  // throws for an unknown name before printing
  RecordReader reader(arguments.store);
  const RecordSource records = [&](const auto& visit) { reader.for_each(visit); };
  const TableView accuracies = pareto(cells, records, arguments.accuracy);
  if (arguments.has_accuracy && accuracies.lines.empty()) {
    throw InputError(arguments.store + ": " + accuracies.notes.front());
  }
  const std::vector<TableView> tables{costs(cells), reported(cells), scaling(cells), accuracies};
  write_output(text(tables, arguments.output),
               arguments.output,
               "profile",
               std::move(provenance),
               arguments.store);
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
  declare(*command,
          arguments->output,
          {ExportFormat::markdown, ExportFormat::terminal, ExportFormat::csv});
  command->callback([arguments, command, &exit_code] {
    for (const char* option : {"--metric", "--relation", "--axis"}) {
      if (command->count(option) > 0) arguments->has_accuracy = true;
    }
    exit_code = print_profile(*arguments);
  });
}

}  // namespace loopbench::harness
