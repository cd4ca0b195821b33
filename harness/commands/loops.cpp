#include "harness/eval/loops.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <sstream>

#include "datasets/formats/g2o.hpp"
#include "harness/base/printable.hpp"
#include "harness/base/write_file.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/options.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/eval/correct.hpp"

namespace loopbench::harness {
namespace {

struct LoopsCommand {
  CorrectArguments input;
  std::string csv;
  std::filesystem::path plot;
  FigureOptions figure;
  bool json = false;
};

/// Vertex ids of a graph, stamps of a trajectory.
std::vector<std::string> keyframe_names(const CorrectArguments& input, const Problem& problem) {
  std::vector<std::string> out;
  if (detect_format(input.estimate) == Format::g2o) {
    const InformationRules any{.indefinite = IndefiniteInformation::project};  // only ids are used
    for (const std::int64_t id : read_g2o(input.estimate, any).ids) {
      out.push_back(std::to_string(id));
    }
  }
  if (out.size() == problem.keyframes.size()) return out;
  out.clear();
  for (const StampedPose& pose : problem.keyframes) out.push_back(to_text(pose.stamp));
  return out;
}

void draw_loops(const LoopsResult& result, const LoopsCommand& a) {
  DrawnFigure figure{{}, {"plane"}, a.figure};
  std::filesystem::path name = a.plot;
  for (const std::string& suffix : take_suffixes(name)) {
    figure.files.emplace_back(name.string() + suffix);
  }
  FigureData data = loops_figure(result);
  data.figures.push_back(figure);
  draw({data});
  fmt::print(stderr, "{}", printable(file_list(figure)));
}

int run_loops(const LoopsCommand& a) {
  constexpr std::size_t kMostRows = 20;  // of a table that fits a screen
  Problem problem = load_problem(a.input, catalogue({}));
  std::vector<std::string> names = keyframe_names(a.input, problem);
  const LoopsResult result = loops(std::move(problem), a.input.estimate, std::move(names));
  if (a.json) {
    fmt::print("{}", json(result));
  } else {
    std::istringstream lines(printable(text(result, kMostRows)));
    for (std::string line; std::getline(lines, line);) fmt::print("{}\n", fitted(line));
  }
  if (!a.csv.empty()) write_file(a.csv, csv(result));
  if (!a.plot.empty()) draw_loops(result, a);
  return is_contradicted(result.ledger.verdict) ? kExitNotShown : kExitOk;
}

}  // namespace

void add_loops(CLI::App& app, int& exit_code) {
  auto a = std::make_shared<LoopsCommand>();
  CLI::App* command = app.add_subcommand(
      "loops", "Check each loop closure by the closures of other places, without a reference");
  CorrectArguments& c = a->input;
  command->add_option("estimate", c.estimate, "Trajectory file, or a g2o graph")
      ->type_name("ESTIMATE")
      ->required();
  command
      ->add_option(
          "--loops",
          c.loops,
          "Loop closures: stamp_from stamp_to tx ty tz qx qy qz qw [sigma_t sigma_r], or a "
          "g2o graph whose vertices are the poses of ESTIMATE")
      ->type_name("FILE");
  const auto set = [&c](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) c.settings.push_back({text});
  };
  command
      ->add_option_function<std::vector<std::string>>(
          "--set",
          set,
          "Option of dataset trajectory (or pose_graph for a graph), see `list datasets`")
      ->type_name("OPTION=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--csv", a->csv, "Write one row per closure; - is standard output")
      ->type_name("FILE");
  command
      ->add_option(
          "--plot",
          a->plot,
          "Map of the keyframes with the closures, as PREFIX.svg, .pdf and .png, or as one "
          "of these or .pgf if PREFIX ends in it")
      ->type_name("PREFIX");
  declare_figures(*command, a->figure, "--plot");
  command->add_flag("--json", a->json, "Print JSON instead of text");
  command->callback([a, &exit_code] { exit_code = run_loops(*a); });
}

}  // namespace loopbench::harness
