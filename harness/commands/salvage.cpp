#include "harness/store/salvage.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <set>

#include "harness/catalogue/load_sequence.hpp"
#include "harness/commands/commands.hpp"
#include "harness/config/read_sweep.hpp"
#include "harness/model/cells.hpp"
#include "harness/store/cell_rows.hpp"
#include "harness/store/read.hpp"
#include "harness/text/printable.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {
namespace {

/// Cells of the stored config that the store does not contain; empty if the config was lost or
/// cannot be read any more.
std::vector<std::string> missing_cells(const std::filesystem::path& store) {
  std::vector<std::string> out;
  try {
    const std::map<std::string, std::string> run = read_run(store);
    const auto config = run.find("config");
    if (config == run.end()) return out;
    const Catalogue known = catalogue({});
    const Sweep sweep = parse_sweep(config->second, "config", known);
    std::set<std::string> there;
    for (const CellRecord& cell : read_cells(store)) there.insert(label_of(cell));
    for (const Cell& cell : cells(sweep, seeded(sweep, known), "")) {
      CellRecord planned;
      planned.sequence = sweep.datasets[cell.dataset].label;
      planned.repeat = cell.repeat;
      planned.method = sweep.methods[cell.method].label;
      if (!there.contains(label_of(planned))) out.push_back(label_of(planned));
    }
  } catch (const InputError&) {
    out.clear();  // for example methods of a plugin
  }
  return out;
}

void print_losses(const Salvaged& salvaged, const std::filesystem::path& out) {
  for (const std::string& label : salvaged.lost) fmt::print("lost: {}\n", printable(label));
  if (salvaged.nameless > 0) {
    fmt::print("lost: {} cells whose names are unreadable\n", salvaged.nameless);
  } else if (salvaged.incomplete) {
    fmt::print("lost: possibly further cells; the list of cells is damaged\n");
  }
  if (salvaged.nameless > 0 || salvaged.incomplete) {
    const std::set<std::string> named(salvaged.lost.begin(), salvaged.lost.end());
    for (const std::string& label : missing_cells(out)) {
      if (!named.contains(label)) fmt::print("lost or never run: {}\n", printable(label));
    }
  }
  for (const std::string& sequence : salvaged.traces) {
    fmt::print("lost: the data for plots of {}\n", printable(sequence));
  }
  if (salvaged.unknown_origin > 0) {
    fmt::print("lost: the provenance of {} cells\n", salvaged.unknown_origin);
  }
  if (salvaged.without_phases > 0) {
    fmt::print("lost: the durations of phases of {} cells\n", salvaged.without_phases);
  }
  if (salvaged.run_lost) fmt::print("lost: the config; run it with this store to write it again\n");
}

}  // namespace

void add_salvage(CLI::App& app, int& exit_code) {
  struct Arguments {
    std::filesystem::path store;
    std::filesystem::path out;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("salvage", "Copy the intact cells of a damaged store into a new one");
  command->add_option("store", arguments->store, "Folder of results, or its results.sqlite")
      ->required();
  command->add_option("-o,--out", arguments->out, "Store to create, or a folder for it")
      ->required();
  command->footer(
      "Prints what is lost. STORE is only read. 'loopbench run CONFIG --out FOLDER' then "
      "recomputes the lost cells.");
  command->callback([arguments, &exit_code] {
    reject_standard_output("-o", arguments->out);
    std::filesystem::path out = arguments->out;
    if (out.extension() != ".sqlite") out /= "results.sqlite";
    const Salvaged salvaged = salvage_store(arguments->store, out);
    fmt::print("{} cells in {}\n", salvaged.cells, out.string());
    print_losses(salvaged, out);
    const bool is_complete = salvaged.lost.empty() && salvaged.nameless == 0 &&
                             !salvaged.incomplete && salvaged.traces.empty() &&
                             salvaged.unknown_origin == 0 && salvaged.without_phases == 0 &&
                             !salvaged.run_lost;
    exit_code = is_complete ? kExitOk : kExitSomeCellsFailed;
  });
}

}  // namespace loopbench::harness
