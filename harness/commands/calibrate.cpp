#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "harness/calibrate/learn.hpp"
#include "harness/commands/commands.hpp"
#include "harness/config/data_root.hpp"
#include "harness/config/read_sweep.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {
namespace {

struct CalibrateArguments {
  std::string config;
  std::string data;
  std::string out;
  LearnOptions learn;
};

int calibrate(const CalibrateArguments& arguments) {
  reject_overwriting({arguments.config}, arguments.out);
  const Catalogue known = catalogue(with_config_plugins({}, arguments.config));
  const Sweep sweep = read_sweep(arguments.config, known, arguments.data);
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
      "calibrate", "Estimate noise variances for motion_drift from sequences with a reference");
  command->add_option("config", arguments->config, "YAML config with the training datasets")
      ->required();
  command
      ->add_option("--train", arguments->learn.train, "Train only on datasets whose label matches")
      ->type_name("REGEX");
  command
      ->add_option("--every",
                   arguments->learn.every,
                   "Number of consecutive edges combined into one; longer groups suppress jitter")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--draws", arguments->learn.draws, "Number of bootstrap samples")
      ->check(CLI::Range(2, 100000))
      ->capture_default_str();
  command->add_option("--data", arguments->data, "Folder with real datasets")
      ->envname("LOOPBENCH_DATA")
      ->type_name("DIR");
  command->add_option("--out", arguments->out, "YAML file to write")->type_name("FILE");
  command->callback([arguments, &exit_code] { exit_code = calibrate(*arguments); });
}

}  // namespace loopbench::harness
