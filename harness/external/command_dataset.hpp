/// The dataset `command`: any program as a SLAM system.
///
/// The program reads {sequence} and writes {trajectory}, the estimate without loop closing, as TUM;
/// and if it has them, next to it, {trajectory}.frames (all tracked poses), {trajectory}.loops
/// (closures, derive/closure_file.hpp) and {trajectory}.closed (its own estimate with loop
/// closing).
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "datasets/trajectory_dataset.hpp"

namespace loopbench::harness {

enum class UsedTrajectory { open, closed };
inline auto choices(UsedTrajectory) {
  return std::array{std::pair{"open", UsedTrajectory::open},
                    std::pair{"closed", UsedTrajectory::closed}};
}

struct CommandDatasetOptions {
  std::string run;
  std::string sequence;
  UsedTrajectory use = UsedTrajectory::open;
  bool shell = false;
  std::string depends;
  TrajectoryOptions trajectory;  ///< the files of the program are set by the loader
};

/// Options of `trajectory` that the program's files determine.
inline constexpr std::array<std::string_view, 7> kProgramFiles{
    "estimate", "frames", "format", "times", "period", "closures.source", "closures.file"};

template <class Visit>
void fields(CommandDatasetOptions& o, Visit visit) {
  visit("run",
        o.run,
        "program and arguments; {sequence}: input, {trajectory}: file to write, {seed}: repeat");
  visit("sequence", o.sequence, "input of the program: a folder or a file; empty: none");
  visit("use", o.use, "trajectory to correct or evaluate; closed: after the program's own closing");
  visit("shell", o.shell, "whether sh interprets the text of run");
  visit("depends", o.depends, "files whose change runs the program again, separated by blanks");
  fields(o.trajectory, [&](const char* name, auto& member, const char* help, const auto&... rule) {
    if (std::ranges::count(kProgramFiles, name) == 0) visit(name, member, help, rule...);
  });
}

/// Throws OptionError without a program, or if run does not name {trajectory}.
void check_combination(const CommandDatasetOptions& options);

/// Runs the program in the first folder of `root`, the config's, unless `cache` has its output for
/// the same command, program files, sequence content and seed. Throws InputError with the end of
/// the program's output if it fails.
Sequence load_command(const CommandDatasetOptions& options,
                      const DataRoot& root,
                      const std::filesystem::path& cache);

}  // namespace loopbench::harness
