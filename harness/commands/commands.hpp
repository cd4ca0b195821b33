/// Subcommands of the program. Each registers itself with the parser and sets the exit code.
#pragma once

#include "harness/sweep/run/build.hpp"

namespace CLI {
class App;
}

namespace loopbench::harness {

inline constexpr int kExitOk = 0;
inline constexpr int kExitSomeCellsFailed = 1;
inline constexpr int kExitRegression = 1;
inline constexpr int kExitNotShown = 1;
inline constexpr int kExitBadInput = 2;
inline constexpr int kExitInternal = 3;
inline constexpr int kExitMissingPart = 4;
inline constexpr int kExitInterrupted = 130;

/// The callbacks throw InputError and OptionError; the program converts them to exit code 2, and
/// MissingPart to 4.
void add_run(CLI::App& app, int& exit_code, const Source& source);
void add_list(CLI::App& app, int& exit_code);
void add_loops(CLI::App& app, int& exit_code);
void add_table(CLI::App& app, int& exit_code);
void add_compare(CLI::App& app, int& exit_code);
void add_check(CLI::App& app, int& exit_code);
void add_complete(CLI::App& app, int& exit_code);
void add_correct(CLI::App& app, int& exit_code);
void add_eval(CLI::App& app, int& exit_code, const Source& source = {});
void add_export(CLI::App& app, int& exit_code);
void add_merge(CLI::App& app, int& exit_code);
void add_plot(CLI::App& app, int& exit_code);
void add_report(CLI::App& app, int& exit_code);
void add_submit(CLI::App& app, int& exit_code);
void add_traj(CLI::App& app, int& exit_code);
void add_doctor(CLI::App& app, int& exit_code);

}  // namespace loopbench::harness
