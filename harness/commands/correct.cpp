#include "harness/eval/correct.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <sstream>

#include "harness/base/printable.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/standard_output.hpp"

namespace loopbench::harness {

void add_correct(CLI::App& app, int& exit_code) {
  struct Arguments {
    CorrectArguments correct;
    std::vector<std::filesystem::path> plugins;
    bool json = false;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("correct", "Correct one trajectory or pose graph with one method");
  CorrectArguments& c = a->correct;
  command->add_option("estimate", c.estimate, "Trajectory file, or a g2o graph")
      ->required()
      ->type_name("ESTIMATE");
  command
      ->add_option(
          "--method",
          c.method,
          "Method, or corrector + smoother; options follow a colon (dual:max_closures=50), "
          "see `list methods`")
      ->required()
      ->type_name("METHOD");
  const auto file = [&](const char* name, std::string& value, const char* help) {
    command->add_option(name, value, help)->type_name("FILE");
  };
  file("--loops",
       c.loops,
       "Loop closures: stamp_from stamp_to tx ty tz qx qy qz qw [sigma_t sigma_r]");
  file("--frames", c.frames, "All tracked poses of the run, if ESTIMATE contains only keyframes");
  command
      ->add_option("--set",
                   c.settings,
                   "Option of dataset trajectory (or pose_graph for a graph), see `list datasets`")
      ->type_name("OPTION=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  auto* dense = command->add_flag("--dense", c.dense, "Output keyframes and frames");
  command->add_option("--at", c.at, "Output poses at the stamps of this trajectory file")
      ->type_name("FILE")
      ->excludes(dense);
  command->add_option("-o,--out", c.out, "Output file; x.g2o: a graph, any other name: TUM")
      ->type_name("FILE");
  command->add_option("--plugin", a->plugins, "Shared object with additional methods")
      ->type_name("FILE");
  command->add_flag("--json", a->json, "Print JSON instead of text");
  command->callback([a, &exit_code] {
    const Correction done = correct(a->correct, catalogue(a->plugins));
    exit_code = kExitOk;
    if (a->json) {
      fmt::print("{}", json(done));
      return;
    }
    std::istringstream lines(printable(text(done)));
    for (std::string line; std::getline(lines, line);) fmt::print("{}\n", fitted(line));
  });
}

}  // namespace loopbench::harness
