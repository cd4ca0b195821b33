#include <fmt/format.h>
#include <unistd.h>

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
  std::string report;
  FigureOptions figure;
  std::string repaired;
  bool next = false;
  bool json = false;
};

/// Shows the work on a terminal, in one line.
void show_progress(const std::string& work) {
  if (isatty(STDERR_FILENO) != 1) return;
  fmt::print(stderr, "\r\033[K{}{}", work, work.empty() ? "" : " ...");
  std::fflush(stderr);
}

int run_loops(const LoopsCommand& a) {
  constexpr std::size_t kMostRows = 20;  // of a table that fits a screen
  reject_standard_output("--report", a.report);
  Provenance provenance;
  Problem problem = load_problem(a.input, catalogue({}), &provenance);
  const LoopsResult result = loops(std::move(problem), a.input.estimate, show_progress);
  std::optional<methods::NextClosures> next;
  if (a.next) {
    show_progress("searching places for one more closure");
    next = next_closures(result);
  }
  show_progress("");
  std::FILE* const out = is_dash(a.csv) ? stderr : stdout;  // rows are on stdout
  fmt::print(out,
             "{}",
             a.json ? json(result, next) : fitted_lines(printable(text(result, kMostRows, next))));
  if (!a.csv.empty()) write_file(a.csv, csv(result));
  if (!a.plot.empty())
    draw_map(loops_figure(result, result.problem.keyframes, false), a.plot, a.figure);
  if (!a.report.empty()) write_file(a.report, loops_page(result));
  if (!a.repaired.empty()) write_repaired(result, provenance, a.repaired);
  return is_contradicted(result) ? kExitNotShown : kExitOk;
}

}  // namespace

void add_loops(CLI::App& app, int& exit_code) {
  auto a = std::make_shared<LoopsCommand>();
  CLI::App* command = app.add_subcommand(
      "loops",
      "Check whether loop closures agree with each other and the odometry, without a reference");
  declare_problem(*command, a->input);
  reads(*command,
        add(*command,
            "--anchors FILE",
            a->input.anchors,
            "Measured positions [s, m]: stamp x y z [sigma, or xx xy xz yy yz zz of the "
            "covariance], or any format of a reference"));
  writes(*command,
         add(*command,
             "-o,--out FILE",
             a->repaired,
             "Write a g2o graph with the closures that agree; wrong odometry steps get less "
             "information"),
         FileKind::trajectory);
  command->add_flag(
      "--next",
      a->next,
      "Print where one more closure would reduce the standard deviation of the positions most");
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
  writes(
      *command,
      add(*command,
          "--report FILE",
          a->report,
          "HTML page with the verdict, maps of the closures before and after the correction, and "
          "tables"),
      FileKind::page);
  remove_option(*command, "--labels");  // colours have a fixed meaning
  command->add_flag("--json", a->json, "Print JSON instead of text");
  command->callback([a, &exit_code] { exit_code = run_loops(*a); });
}

}  // namespace loopbench::harness
