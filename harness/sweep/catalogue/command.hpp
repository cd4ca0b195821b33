/// The method `command`: any program as a corrector.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "harness/sweep/catalogue/exchange.hpp"
#include "harness/sweep/process/own_process.hpp"
#include "harness/sweep/process/program.hpp"
#include "methods/method.hpp"

namespace loopbench::harness {

/// Name of the method, the dataset and the metric that run a program.
inline constexpr const char* kCommand = "command";

struct CommandOptions {
  std::string run;
  std::string serve;
  bool updates = false;
  bool shell = false;
  ResultPoses output = ResultPoses::keyframes;
  std::string depends;
  std::string version;
  bool network = false;
  // No options:
  std::filesystem::path folder = ".";  ///< working directory: that of the config
  std::string role = "method";         ///< or "metric", whose processes have seen references
};

template <class Visit>
void fields(CommandOptions& o, Visit visit) {
  visit("run", o.run, "program and arguments; {problem}: folder to read, {result}: file to write");
  visit("serve",
        o.serve,
        "program that stays running and exchanges problems over its standard streams, instead of "
        "run");
  visit("updates",
        o.updates,
        "serve: in a replay, a request contains what has arrived since the last one");
  visit("shell", o.shell, "whether sh interprets the text of run or serve");
  visit("output", o.output, "poses of the result");
  visit("depends", o.depends, "files whose change recomputes the cells, separated by blanks");
  visit("version", o.version, "command whose output is the version; its change recomputes cells");
  visit("network", o.network, "whether the program can use the network");
}

/// Throws OptionError unless exactly one of run and serve is set and can be split, run names
/// {input} and {result}, and `updates` has a program that serves keyframes.
void check_combination(const CommandOptions& options, const std::string& input = "problem");

/// A start of `run`: {NAME} is the file of that name, also as variable LOOPBENCH_NAME, or one of
/// `values`. It can write in `writable`, its TMPDIR. Throws OptionError.
ProgramStart start_on(const std::map<std::string, std::filesystem::path>& files,
                      const std::filesystem::path& writable,
                      const std::string& run,
                      bool shell,
                      std::map<std::string, std::string> values = {});

/// A program that was started for one input and has ended.
struct ProgramRun {
  double seconds = 0.0;  ///< from start to end
  ProgramEnd end;
  std::string output;  ///< the end of what it printed
};

/// Runs the program of `run` in its folder; {NAME} is FOLDER/NAME and {result} is FOLDER/result,
/// also as variables LOOPBENCH_NAME and LOOPBENCH_RESULT. It can write in `folder`. Throws
/// std::runtime_error if it fails.
ProgramRun run_in_folder(const CommandOptions& options,
                         const std::string& name,
                         const std::filesystem::path& folder);

/// Content of a regular file of at most 256 MiB; "" if there is none. Throws std::runtime_error.
std::string result_text(const std::filesystem::path& file);

/// A corrector, or a joint method for output: dense. Throws OptionError.
methods::Stage make_command(const CommandOptions& options);

/// Words of a command line, or sh with that line. Throws OptionError.
std::vector<std::string> command_words(const std::string& option,
                                       const std::string& text,
                                       bool shell);

/// Hashes of the files that the command line and `depends` name, and the output of `version`, which
/// runs under these limits. Throws InputError if a file under `depends` is missing or `version`
/// fails.
std::string command_version(const CommandOptions& options, const ProcessLimits& limits);

/// `why`, with the end of a program's output.
std::string with_output(const std::string& why, const std::string& output);

/// Adds the end of a program's output as a note.
void add_output(methods::Report& report, const std::string& output);

}  // namespace loopbench::harness
