/// Files that `traj` writes.
#pragma once

#include <functional>
#include <vector>

#include "harness/commands/files/named_trajectory.hpp"
#include "harness/commands/traj/traj_options.hpp"

namespace loopbench::harness {

using NamedTrajectories = std::vector<NamedTrajectory>;

/// Writes them to the files of the arguments (with --json none without -o), and says what a format
/// loses. Returns the exit code. Throws InputError.
int write_all(const TrajArguments& a, const NamedTrajectories& all);

/// Reads, changes and writes the files; exact stamps stay valid only if no stamp has changed.
/// Returns the exit code. Throws InputError.
int write_changed(const TrajArguments& a,
                  const std::function<void(NamedTrajectory&)>& change,
                  const NamedTrajectory* reference = nullptr);

}  // namespace loopbench::harness
