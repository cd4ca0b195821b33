#include "harness/catalogue/external_methods.hpp"

#include <algorithm>

#include "harness/catalogue/command_dataset.hpp"
#include "harness/catalogue/command_metric.hpp"
#include "harness/catalogue/server.hpp"

namespace loopbench::harness {
namespace {

constexpr const char* kCommand = "command";

/// Options of a stage that runs a program.
CommandOptions command_options(const Params& given) { return with(CommandOptions{}, given); }

bool has_program(const MethodChoice& choice) {
  return std::ranges::any_of(choice.stages, is_program);
}

}  // namespace

methods::MethodEntry command_entry() {
  return {kCommand,
          methods::Kind::corrector,
          "any program; see methods/bring_a_method.md",
          describe(CommandOptions{}),
          [](const Params& given) { return make_command(command_options(given), {}); }};
}

bool is_program(const Choice& stage) { return stage.name == kCommand; }

methods::Stage make_program(const Choice& stage, const CommandSetting& setting) {
  return make_command(command_options(stage.options), setting);
}

std::string program_version(const Choice& stage, const CommandSetting& setting) {
  return command_version(command_options(stage.options), setting);
}

CommandSetting command_setting(const Sweep& sweep) {
  const std::filesystem::path folder = sweep.config.parent_path();
  return {folder.empty() ? "." : folder};
}

bool uses_programs(const Sweep& sweep) {
  const auto is_program_dataset = [](const DatasetChoice& choice) {
    return choice.dataset.name == kCommandDataset;
  };
  const auto is_program_metric = [](const MetricChoice& choice) {
    return choice.metric.name == kCommandMetric;
  };
  return std::ranges::any_of(sweep.datasets, is_program_dataset) ||
         std::ranges::any_of(sweep.methods, has_program) ||
         std::ranges::any_of(sweep.metrics, is_program_metric);
}

std::unique_ptr<const ScratchFolder> scratch_for_programs(const Sweep& sweep) {
  return uses_programs(sweep) ? std::make_unique<const ScratchFolder>() : nullptr;
}

void prepare_programs(const MethodChoice& choice, const Sweep& sweep) {
  const auto prepare = [&](const CommandOptions& options) {
    if (options.serve.empty()) return;
    try {
      prepare_server(options, command_setting(sweep));
    } catch (const std::exception&) {  // asking fails for the same reason and reports it
    }
  };
  for (const Choice& stage : choice.stages) {
    if (is_program(stage)) prepare(command_options(stage.options));
  }
  for (const MetricChoice& metric : sweep.metrics) {
    if (metric.metric.name == kCommandMetric) prepare(program_of_metric(metric.metric.options));
  }
}

std::string metric_program_version(const Choice& metric, const CommandSetting& setting) {
  if (metric.name != kCommandMetric) return "";
  return command_version(program_of_metric(metric.options), setting);
}

}  // namespace loopbench::harness
