/// Writes the trajectories of `traj`.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/commands/traj_options.hpp"

namespace loopbench::harness {

using NamedTrajectories = std::vector<NamedTrajectory>;

std::vector<std::string> names_of(const NamedTrajectories& all);

/// Rejects output files that are among the inputs.
void protect_inputs(const TrajArguments& arguments, const std::vector<std::string>& outputs);

/// Writes them to the files of the arguments, and says what a format loses. Returns the exit code.
int write_all(const TrajArguments& arguments, const NamedTrajectories& all);

/// Reads, changes and writes the files; exact stamps stay valid only if no stamp has changed.
int write_changed(const TrajArguments& arguments,
                  const std::function<void(NamedTrajectory&)>& change);

}  // namespace loopbench::harness
