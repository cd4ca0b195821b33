#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/correct/correct.hpp"
#include "harness/commands/loops/loops.hpp"
#include "harness/commands/options.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {
namespace {

struct LoopsCommand {
  CorrectArguments input;
  std::string csv;
  std::filesystem::path plot;
  FigureOptions figure;
  bool json = false;
};

int run_loops(const LoopsCommand& a) {
  constexpr std::size_t kMostRows = 20;  // of a table that fits a screen
  LoopsResult result = loops(load_problem(a.input, catalogue({})), a.input.estimate);
  add_rejections(result);
  std::FILE* const out = is_dash(a.csv) ? stderr : stdout;  // rows are on stdout
  fmt::print(out, "{}", a.json ? json(result) : fitted_lines(printable(text(result, kMostRows))));
  if (!a.csv.empty()) write_file(a.csv, csv(result));
  if (!a.plot.empty()) draw_map(loops_figure(result), a.plot, a.figure);
  return is_contradicted(result.ledger.verdict) ? kExitNotShown : kExitOk;
}

}  // namespace

void add_loops(CLI::App& app, int& exit_code) {
  auto a = std::make_shared<LoopsCommand>();
  CLI::App* command = app.add_subcommand(
      "loops", "Check each loop closure by the closures of other places, without a reference");
  declare_problem(*command, a->input);
  writes(*command,
         add(*command, "--csv FILE", a->csv, "Write one row per closure; - is standard output"),
         FileKind::printed);
  writes(
      *command,
      add(*command,
          "--plot FILE",
          a->plot,
          "Map of the keyframes with the closures: .pdf, .svg, .png or .pgf (default: FILE.pdf)"),
      FileKind::figure);
  declare_figures(*command, a->figure, "--plot");
  command->remove_option(command->get_option("--labels"));  // colours have a fixed meaning
  command->add_flag("--json", a->json, "Print JSON instead of text");
  command->callback([a, &exit_code] { exit_code = run_loops(*a); });
}

}  // namespace loopbench::harness
