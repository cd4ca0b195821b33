#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "harness/calibrate/calibration_text.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/data_root.hpp"
#include "harness/config/read_sweep.hpp"
#include "harness/export/write_file.hpp"
#include "harness/pattern/pattern.hpp"
#include "harness/run/sequences.hpp"

namespace loopbench {
namespace {

struct CalibrateArguments {
  std::string config;
  std::string train;
  std::string data;
  std::string out;
  std::size_t every = 10;
  int draws = 50;
};

constexpr std::size_t kStretches[] = {1, 5, 20, 50};
constexpr std::size_t kSegment = 10;  // block length of the bootstrap, in edge groups
constexpr std::uint64_t kSeed = 1;

std::vector<Residuals> residuals_of(const std::vector<std::shared_ptr<const Sequence>>& sequences,
                                    const std::vector<std::string>& labels,
                                    std::size_t every) {
  std::vector<Residuals> out;
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    Residuals all = residuals(*sequences[i], labels[i], every);
    if (all.edges.size() > 1) out.push_back(std::move(all));
  }
  return out;
}

int calibrate(const CalibrateArguments& arguments) {
  refuse_to_overwrite({arguments.config}, arguments.out);
  const Catalogue known = catalogue({});
  const Sweep sweep = read_sweep(arguments.config, known);
  const Pattern train = Pattern::of_option("--train", arguments.train);
  std::vector<Cell> wanted;
  Calibration out;
  out.config = std::filesystem::path(arguments.config).filename().string();
  out.every = arguments.every;
  for (std::size_t d = 0; d < sweep.datasets.size(); ++d) {
    if (train.is_in(sweep.datasets[d].label)) {
      wanted.push_back({.index = wanted.size(), .dataset = d});
    } else {
      out.not_trained_on.push_back(sweep.datasets[d].label);
    }
  }
  if (wanted.empty()) {
    throw InputError(arguments.config + ": no dataset's label matches '" + arguments.train + "'");
  }

  Sequences sequences(sweep, known, data_root(sweep, arguments.data), wanted);
  std::vector<std::shared_ptr<const Sequence>> loaded;
  std::vector<std::string> labels;
  for (const Cell& cell : wanted) {
    loaded.push_back(sequences.get(cell));
    labels.push_back(sweep.datasets[cell.dataset].label);
    const std::string& source = sequences.facts(cell)->source;
    if (std::ranges::count(out.sources, source) == 0) out.sources.push_back(source);
  }
  out.sequences = residuals_of(loaded, labels, out.every);
  if (out.sequences.empty()) {
    throw InputError(arguments.config + ": no dataset has two groups of " +
                     std::to_string(out.every) + " edges; use a smaller --every");
  }
  for (const std::size_t edges : kStretches) {
    const std::vector<Residuals> at = residuals_of(loaded, labels, edges);
    if (at.size() < out.sequences.size()) break;
    out.stretches.push_back(
        {edges, {root_mean_square(Half::translation, at), root_mean_square(Half::rotation, at)}});
  }
  out.rungs = climb(out.sequences);
  for (const Rung& rung : out.rungs) {
    out.intervals.push_back(bootstrap(rung, out.sequences, kSegment, arguments.draws, kSeed));
  }
  const std::string text = calibration_yaml(out);
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
  command->add_option("--train", arguments->train, "Train only on datasets whose label matches")
      ->type_name("REGEX");
  command
      ->add_option("--every",
                   arguments->every,
                   "Number of consecutive edges combined into one; longer groups suppress jitter")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--draws", arguments->draws, "Number of bootstrap samples")
      ->check(CLI::Range(2, 100000))
      ->capture_default_str();
  command->add_option("--data", arguments->data, "Folder with real datasets")
      ->envname("LOOPBENCH_DATA")
      ->type_name("DIR");
  command->add_option("--out", arguments->out, "YAML file to write")->type_name("FILE");
  command->callback([arguments, &exit_code] { exit_code = calibrate(*arguments); });
}

}  // namespace loopbench
