#include "harness/external/external_methods.hpp"

#include <algorithm>

#include "harness/external/external_datasets.hpp"
#include "harness/external/server.hpp"

namespace loopbench::harness {
namespace {

CommandOptions command_options(const Params& given) { return with(CommandOptions{}, given); }

ExternalMethod command_entry() {
  const auto make = [](const Params& given, const CommandSetting& setting) {
    return make_command(command_options(given), setting);
  };
  return {{"command",
           methods::Kind::corrector,
           "any program; see methods/bring_a_method.md",
           describe(CommandOptions{}),
           [make](const Params& given) { return make(given, CommandSetting{}); }},
          make,
          [](const Params& given, const CommandSetting& setting) {
            return command_version(command_options(given), setting);
          },
          [](const Params& given, const CommandSetting& setting) {
            const CommandOptions options = command_options(given);
            if (!options.serve.empty()) prepare_server(options, setting);
          }};
}

}  // namespace

const std::vector<ExternalMethod>& external_methods() {
  static const std::vector<ExternalMethod> all{command_entry()};
  return all;
}

const ExternalMethod* find_external(const std::string& name) {
  const auto found = std::ranges::find(
      external_methods(), name, [](const ExternalMethod& each) { return each.listed.name; });
  return found == external_methods().end() ? nullptr : &*found;
}

CommandSetting command_setting(const Sweep& sweep) {
  const std::filesystem::path folder = sweep.config.parent_path();
  return {folder.empty() ? "." : folder};
}

bool runs_programs(const MethodChoice& choice) {
  return std::ranges::any_of(
      choice.stages, [](const Choice& stage) { return find_external(stage.name) != nullptr; });
}

bool uses_programs(const Sweep& sweep) {
  const auto runs_program = [](const DatasetChoice& choice) {
    return choice.dataset.name == kCommandDataset;
  };
  if (std::ranges::any_of(sweep.datasets, runs_program)) return true;
  return std::ranges::any_of(sweep.methods, runs_programs);
}

std::unique_ptr<const ScratchFolder> scratch_for_programs(const Sweep& sweep) {
  if (!uses_programs(sweep)) return nullptr;
  auto out = std::make_unique<const ScratchFolder>();
  set_uncached_programs(out->path() / "programs");
  return out;
}

void prepare_programs(const MethodChoice& choice, const CommandSetting& setting) {
  for (const Choice& stage : choice.stages) {
    const ExternalMethod* external = find_external(stage.name);
    if (external == nullptr) continue;
    try {
      external->prepare(stage.options, setting);
    } catch (const std::exception&) {  // asking fails for the same reason and reports it
    }
  }
}

}  // namespace loopbench::harness
