#include "harness/profile/profile.hpp"

#include <CLI/CLI.hpp>

#include "harness/commands/commands.hpp"
#include "harness/commands/write_output.hpp"
#include "harness/store/read.hpp"
#include "harness/text/pattern.hpp"

namespace loopbench::harness {
namespace {

struct ProfileArguments {
  std::string store;
  std::string only;
  std::string format = "markdown";
  std::string out;
  Accuracy accuracy;
};

int print_profile(const ProfileArguments& arguments) {
  const Pattern selected = Pattern::of_option("--only", arguments.only);
  std::vector<CellRecord> cells = read_cells(arguments.store);
  std::erase_if(cells, [&](const CellRecord& cell) {
    return !selected.is_in(cell.sequence + " / " + cell.method);
  });
  if (cells.empty()) throw InputError(arguments.store + ": no cell matches --only");
  value(Record{}, arguments.accuracy.value);  // throws for an unknown name before printing
  const bool is_csv = arguments.format == "csv";
  std::string out;
  for (const TextTable& listing :
       {costs(cells),
        reported(cells),
        scaling(cells),
        pareto(cells, read_records(arguments.store), arguments.accuracy)}) {
    out += (out.empty() ? "" : "\n") + (is_csv ? csv(listing) : markdown(listing));
  }
  write_output(out,
               is_csv ? ExportFormat::csv : ExportFormat::markdown,
               "profile",
               arguments.store,
               arguments.out);
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
  command->add_option("--relation", arguments->accuracy.relation)->capture_default_str();
  command->add_option("--axis", arguments->accuracy.axis)->capture_default_str();
  command
      ->add_option("--value", arguments->accuracy.value, "Statistic: rmse mean median std min max")
      ->capture_default_str();
  command->add_option("--format", arguments->format)
      ->check(CLI::IsMember({"markdown", "csv"}))
      ->capture_default_str();
  command
      ->add_option("-o,--out",
                   arguments->out,
                   "File to write (-: standard output); for CSV also its provenance")
      ->type_name("FILE");
  command->callback([arguments, &exit_code] { exit_code = print_profile(*arguments); });
}

}  // namespace loopbench::harness
