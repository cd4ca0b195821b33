#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "datasets/core/error.hpp"
#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/config_path.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/commands/submit/slurm_scripts.hpp"
#include "harness/commands/write_output.hpp"
#include "harness/sweep/process/program.hpp"
#include "harness/sweep/process/shell.hpp"
#include "harness/sweep/process/write_file.hpp"

namespace loopbench::harness {
namespace {

namespace fs = std::filesystem;

struct SubmitArguments {
  std::string config;
  std::string out;
  std::string header;
  int array = 8;
  bool print = false;
  std::vector<std::string> options;  ///< of `run`
};

std::string header_text(const std::string& given) {
  const fs::path file = given.empty() ? settings_file("slurm.sh") : fs::path(given);
  if (given.empty() && !fs::exists(file)) return "";
  std::ifstream in(file);
  if (!in) throw InputError(file.string() + ": cannot be read");
  return {std::istreambuf_iterator<char>(in), {}};
}

ProgramEnd run_program(const std::vector<std::string>& words, std::string& output) {
  ProgramStart start;
  start.arguments = words;
  start.folder = ".";
  for (const char* name : {"LOOPBENCH_DATA", "LOOPBENCH_CACHE"}) {  // hidden from other programs
    if (const char* value = std::getenv(name)) start.environment.emplace_back(name, value);
  }
  return RunningProgram(start).wait(output);
}

/// What `run` rejects is rejected now, and not by every task.
void check_options(const SlurmSweep& sweep) {
  std::vector<std::string> words{sweep.program.string(), "run", sweep.config.string()};
  words.insert(words.end(), sweep.options.begin(), sweep.options.end());
  words.insert(words.end(), {"--out", sweep.out.string(), "--dry-run"});
  std::string line;
  for (const std::string& word : words) line += shell_quoted(word) + " ";
  std::string errors;
  if (run_program({"sh", "-c", line + ">/dev/null"}, errors).exit_code == 0) return;
  const std::string prefix = "loopbench: ";
  while (errors.ends_with('\n')) errors.pop_back();
  throw InputError(errors.starts_with(prefix) ? errors.substr(prefix.size()) : errors);
}

/// Submits a script and returns Slurm's number of the job.
std::string submitted(const fs::path& script, const std::string& after) {
  std::vector<std::string> words{
      "sbatch", "--parsable", "--chdir=" + script.parent_path().string()};
  if (!after.empty()) words.push_back("--dependency=afterany:" + after);
  words.push_back(script.string());
  std::string output;
  const ProgramEnd end = run_program(words, output);
  if (end.start_error != 0) {
    throw InputError(
        "sbatch: cannot be started; without Slurm, run the scripts of `submit --print`");
  }
  const std::string number = output.substr(0, output.find_first_of(";\n"));
  if (end.exit_code != 0) throw InputError("sbatch: did not accept the job: " + output);
  return number;
}

int submit(const SubmitArguments& arguments) {
  SlurmSweep sweep;
  sweep.config = fs::absolute(config_path(arguments.config));
  sweep.name = sweep.config.stem().string();
  sweep.program = fs::read_symlink("/proc/self/exe");
  sweep.out = fs::absolute(arguments.out.empty() ? "results/" + sweep.name : arguments.out)
                  .lexically_normal();
  sweep.shards = arguments.array;
  sweep.options = arguments.options;
  sweep.header = header_text(arguments.header);
  check_options(sweep);
  const std::string shards = slurm_shard_script(sweep);
  const std::string merge = slurm_merge_script(sweep);
  if (arguments.print) {
    fmt::print("{}\n{}", shards, merge);
    return kExitOk;
  }
  fs::create_directories(sweep.out / "logs");
  write_result(sweep.out / "shards.sh", shards);
  write_result(sweep.out / "merge.sh", merge);
  const std::string array = submitted(sweep.out / "shards.sh", "");
  const std::string last = submitted(sweep.out / "merge.sh", array);
  fmt::print(
      "{} shards: job {}, then merged by job {}\nnext:\n"
      "  squeue --jobs {},{}\n"
      "  scancel {} {}    # finished cells are kept, and `submit` again continues\n"
      "  {} table {}\n",
      sweep.shards,
      array,
      last,
      array,
      last,
      array,
      last,
      program_name(),
      shell_quoted(sweep.out.string()));
  return kExitOk;
}

}  // namespace

void add_submit(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<SubmitArguments>();
  SubmitArguments& a = *arguments;
  CLI::App& command = *app.add_subcommand("submit", "Run a sweep as an array job of Slurm");
  declare_config(command, a.config);
  add(command, "--array", a.array, "Number of shards, one per task")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  add(command,
      "--header FILE",
      a.header,
      "File with lines for both scripts: #SBATCH options (time, memory, partition), then commands "
      "before the run (default: ~/.config/loopbench/slurm.sh)");
  command.add_flag("--print", a.print, "Print the scripts without submitting them");
  add(command, "--out DIR", a.out, "Output folder (default: results/CONFIG)");
  add(command, "options", a.options, "After --: options of `run`, for example --only");
  command.callback([arguments, &exit_code] { exit_code = submit(*arguments); });
}

}  // namespace loopbench::harness
