/// Methods that run programs; unlike others they need to know where and under which limits.
#pragma once

#include <functional>
#include <memory>

#include "harness/external/command.hpp"
#include "harness/external/scratch.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

struct ExternalMethod {
  methods::MethodEntry listed;  ///< its make() uses the current folder and no limits
  std::function<methods::Stage(const Params&, const CommandSetting&)> make;  ///< throws OptionError
  /// Changes with the program. Throws InputError.
  std::function<std::string(const Params&, const CommandSetting&)> version;
  /// Starts a serving program in this process, see server.hpp. Does not throw: asking reports it.
  std::function<void(const Params&, const CommandSetting&)> prepare;
};

/// All of them, in the order of the catalogue.
const std::vector<ExternalMethod>& external_methods();

/// The one of that name, or null.
const ExternalMethod* find_external(const std::string& name);

/// Programs of a sweep run in the folder of its config, under its memory limit.
CommandSetting command_setting(const Sweep& sweep);

/// Whether any stage of the method runs a program.
bool runs_programs(const MethodChoice& choice);

/// Whether any of its methods or datasets runs programs.
bool uses_programs(const Sweep& sweep);

/// Temporary files of the programs of a sweep and its workers; null unless it uses programs.
std::unique_ptr<const ScratchFolder> scratch_for_programs(const Sweep& sweep);

/// prepare() of the stages of a method that are external.
void prepare_programs(const MethodChoice& choice, const CommandSetting& setting);

}  // namespace loopbench::harness
