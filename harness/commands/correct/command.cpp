#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <utility>

#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/correct/correct.hpp"
#include "harness/commands/options.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/commands/traj/traj_options.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {

namespace {

struct CorrectCommand {
  CorrectArguments correct;
  std::string to;  ///< format of the output
  std::vector<std::filesystem::path> plugins;
  std::filesystem::path plot;
  FigureOptions figure;
  bool json = false;
};

void draw_correction(const Correction& done, const CorrectCommand& a) {
  FigureData data = before_and_after(done);
  const std::vector<std::string> labels = labels_of(a.figure, {"before", "after"});
  for (std::size_t i = 0; i < labels.size(); ++i) data.curves[i].name = labels[i];
  draw_map(std::move(data), a.plot, a.figure);
}

int run_correct(CorrectCommand& a) {
  a.correct.format = written_format(a.correct.out, a.to);
  const Correction done = correct(a.correct, catalogue(a.plugins));
  std::FILE* const out = is_dash(a.correct.out) ? stderr : stdout;  // poses are on stdout
  fmt::print(out, "{}", a.json ? json(done) : fitted_lines(printable(text(done))));
  if (!a.plot.empty()) draw_correction(done, a);
  return kExitOk;
}

}  // namespace

void add_correct(CLI::App& app, int& exit_code) {
  auto a = std::make_shared<CorrectCommand>();
  CLI::App* command =
      app.add_subcommand("correct", "Correct one trajectory or pose graph with one method");
  CorrectArguments& c = a->correct;
  declare_problem(*command, c);
  CLI::Option* const method = add(
      *command,
      "--method METHOD",
      c.method,
      "Method, or corrector + smoother; options follow a colon (dual:max_closures=50), see `list "
      "methods` (default: consensus, or pose_graph where that does not apply)");
  command
      ->add_flag("--trust-loops",
                 c.trusts_loops,
                 "Correct by pose_graph with all closures, even if some contradict the others")
      ->excludes(method);
  command->add_flag("--gravity",
                    c.gravity,
                    "Keep roll and pitch of each keyframe at their input values (visual-inertial "
                    "odometry); the z axis of the world must be vertical");
  const auto file = [&](const char* name, std::string& value, const char* help) {
    reads(*command, command->add_option(name, value, help))->type_name("FILE");
  };
  file("--anchors",
       c.anchors,
       "Measured positions [s, m]: stamp x y z [sigma, or xx xy xz yy yz zz of the covariance], or "
       "any format of a reference");
  add(*command,
      "--start-equals-end METRES",
      c.start_equals_end,
      "Add a closure: the last position equals the first, with this standard deviation [m]; the "
      "rotation is not measured")
      ->check(finite_number())
      ->check(positive_number());
  file("--frames", c.frames, "All tracked poses of the run, if ESTIMATE contains only keyframes");
  auto* dense = command->add_flag("--dense", c.dense, "Output keyframes and frames");
  reads(*command,
        add(*command, "--at FILE", c.at, "Output poses at the stamps of this trajectory file"))
      ->excludes(dense);
  writes(*command,
         add(*command, "-o,--out FILE", c.out, "Output file; - is standard output"),
         FileKind::trajectory);
  add(*command,
      "--to WORD:" + fmt::format("{}", fmt::join(written_formats(), "|")),
      a->to,
      "Output format (default: csv, g2o or kitti if -o ends in .csv, .g2o or .kitti, otherwise "
      "tum); g2o contains all edges");
  writes(*command,
         add(*command,
             "--plot FILE",
             a->plot,
             "Map of the keyframes before and after: .pdf, .svg, .png or .pgf (default: FILE.pdf)"),
         FileKind::figure);
  declare_figures(*command, a->figure, "--plot");
  writes(*command,
         add(*command,
             "--ledger FILE",
             c.ledger,
             "CSV file with one row per closure, showing how well others predict it (as `loops "
             "--csv`)"),
         FileKind::printed);
  add(*command, "--plugin FILE", a->plugins, "Shared object with additional methods")
      ->allow_extra_args(false);
  command->add_flag("--json", a->json, "Print JSON instead of text");
  command->callback([a, &exit_code] { exit_code = run_correct(*a); });
}

}  // namespace loopbench::harness
