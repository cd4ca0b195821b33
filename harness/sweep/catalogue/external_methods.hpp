/// Methods that run programs; unlike others they need to know where.
#pragma once

#include <memory>

#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/catalogue/command.hpp"
#include "harness/sweep/catalogue/scratch.hpp"
#include "harness/sweep/model/sweep.hpp"

namespace loopbench::harness {

/// The method `command`; its make() uses the current folder.
methods::MethodEntry command_entry();

/// Whether a dataset, a metric or a stage of a method runs a program.
bool is_program(const Choice& choice);

/// Options of a stage or metric that runs a program, in the folder of the sweep's config. Throws
/// OptionError.
CommandOptions command_options(const Params& options, const Sweep& sweep);

/// Whether any of its methods, metrics or datasets runs programs.
bool uses_programs(const Sweep& sweep);

/// "method mine", "metric height": programs whose config says `network: true`, one per line.
std::string programs_with_network(const Sweep& sweep);

/// Temporary files of the programs of a sweep and its workers; null unless it uses programs.
std::unique_ptr<const ScratchFolder> scratch_for_programs(const Sweep& sweep);

/// Starts the serving programs of a method and of all metrics in this process, see server.hpp. Does
/// not throw: asking reports what fails.
void prepare_programs(const MethodChoice& choice, const Sweep& sweep);

/// Combines the stages of a choice into one method; only an oracle has access to `reference`, and
/// programs run in the folder of the sweep's config. Throws InputError, OptionError.
std::unique_ptr<const methods::Estimator> make_method(const MethodChoice& choice,
                                                      const Catalogue& catalogue,
                                                      const Trajectory& reference,
                                                      const Sweep& sweep = {});

}  // namespace loopbench::harness
