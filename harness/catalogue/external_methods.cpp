#include "harness/catalogue/external_methods.hpp"

#include <algorithm>

#include "harness/catalogue/command_dataset.hpp"
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
  return std::ranges::any_of(sweep.datasets, is_program_dataset) ||
         std::ranges::any_of(sweep.methods, has_program);
}

std::unique_ptr<const ScratchFolder> scratch_for_programs(const Sweep& sweep) {
  return uses_programs(sweep) ? std::make_unique<const ScratchFolder>() : nullptr;
}

void prepare_programs(const MethodChoice& choice, const CommandSetting& setting) {
  for (const Choice& stage : choice.stages) {
    if (!is_program(stage)) continue;
    const CommandOptions options = command_options(stage.options);
    if (options.serve.empty()) continue;
    try {
      prepare_server(options, setting);
    } catch (const std::exception&) {  // asking fails for the same reason and reports it
    }
  }
}

}  // namespace loopbench::harness
