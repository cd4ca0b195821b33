#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "harness/calibrate/learn.hpp"
#include "harness/commands/commands.hpp"
#include "harness/config/data_root.hpp"
#include "harness/config/read_sweep.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench {
namespace {

struct CalibrateArguments {
  std::string config;
  std::string data;
  std::string out;
  LearnOptions learn;
};

int calibrate(const CalibrateArguments& arguments) {
  refuse_to_overwrite({arguments.config}, arguments.out);
  const Catalogue known = catalogue({});
  const Sweep sweep = read_sweep(arguments.config, known);
  const DataRoot root = data_root(sweep, arguments.data);
  const std::string text = calibration_yaml(learn(sweep, known, root, arguments.learn));
  fmt::print("{}", text);
  if (!arguments.out.empty() && !is_dash(arguments.out)) write_file(arguments.out, text);
  return kExitOk;
}

}  // namespace

void add_calibrate(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* command = app.add_subcommand(
      "calibrate", "Learn motion_drift's variances from sequences whose truth is known");
  command->add_option("config", arguments->config, "YAML file whose datasets to learn from")
      ->required();
  command->add_option("--train", arguments->learn.train, "Only datasets whose label matches")
      ->type_name("REGEX");
  command
      ->add_option("--every",
                   arguments->learn.every,
                   "Edges taken as one: a longer stretch drowns jitter that does not add up")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--draws", arguments->learn.draws, "Of the bootstrap")
      ->check(CLI::Range(2, 100000))
      ->capture_default_str();
  command->add_option("--data", arguments->data, "Folder with real data")
      ->envname("LOOPBENCH_DATA")
      ->type_name("DIR");
  command->add_option("--out", arguments->out, "YAML file to write")->type_name("FILE");
  command->callback([arguments, &exit_code] { exit_code = calibrate(*arguments); });
}

}  // namespace loopbench
