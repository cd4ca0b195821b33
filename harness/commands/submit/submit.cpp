#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

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
  constexpr std::streamsize kMost = 1 << 20;  // [bytes]
  std::ifstream in(file);
  std::string out(static_cast<std::size_t>(kMost) + 1, '\0');
  if (!in || !in.read(out.data(), kMost + 1).eof()) {
    if (in && in.gcount() > kMost) {
      throw InputError(file.string() + ": has more than 1 MiB, expected lines for a script");
    }
    throw InputError(file.string() + ": cannot be read");
  }
  out.resize(static_cast<std::size_t>(in.gcount()));
  return out;
}

/// Its standard error is that of this process.
ProgramEnd run_program(const std::vector<std::string>& words, std::string& output) {
  ProgramStart start;
  start.arguments = words;
  start.folder = ".";
  start.shows_errors = true;
  for (const char* name : {"LOOPBENCH_DATA", "LOOPBENCH_CACHE"}) {  // hidden from other programs
    if (const char* value = std::getenv(name)) start.environment.emplace_back(name, value);
  }
  return RunningProgram(start).wait(output);
}

/// Throws InputError for an option of `run` that the script sets itself.
void reject_own_options(const std::vector<std::string>& options) {
  const auto is = [](std::string word, const std::string& name) {
    if (word.starts_with("--")) std::ranges::replace(word, '_', '-');
    if (name.size() == 2) return word.starts_with(name);  // also -j3
    return word == name || word.starts_with(name + "=");
  };
  for (const std::string& word : options) {
    for (const char* const own : {"--shard", "--jobs", "-j", "--out", "-o", "--dry-run"}) {
      if (!is(word, own)) continue;
      throw InputError("-- " + word + ": submit sets " + own +
                       " itself; use --array for shards, --out of submit for the folder, and "
                       "#SBATCH --cpus-per-task in the header for workers");
    }
  }
}

/// Whether `run` accepts the options; it prints what it rejects, now and not in every task.
bool are_accepted(const SlurmSweep& sweep) {
  std::vector<std::string> words{sweep.program.string(), "run", sweep.config.string()};
  words.insert(words.end(), sweep.options.begin(), sweep.options.end());
  words.insert(words.end(), {"--out", sweep.out.string(), "--dry-run"});
  std::string line;
  for (const std::string& word : words) line += shell_quoted(word) + " ";
  std::string output;
  return run_program({"sh", "-c", line + ">/dev/null"}, output).exit_code == 0;
}

/// The number in the last line of `sbatch --parsable`: NUMBER or NUMBER;CLUSTER.
std::string job_number(std::string output) {
  while (output.ends_with('\n')) output.pop_back();
  const std::string last = output.substr(output.find_last_of('\n') + 1);
  const std::string number = last.substr(0, last.find(';'));
  if (!number.empty() && number.find_first_not_of("0123456789") == std::string::npos) return number;
  throw InputError("sbatch: printed '" + last +
                   "', expected the number of the job, which may run; see squeue");
}

/// Submits a script and returns Slurm's number of the job. Warnings of sbatch are passed on.
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
  if (end.exit_code != 0) {
    throw InputError("sbatch: did not accept the job: it " + text(end) + "; its reason is above");
  }
  return job_number(output);
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
  reject_own_options(sweep.options);
  if (!are_accepted(sweep)) return kExitBadInput;
  const std::string shards = slurm_shard_script(sweep);
  const std::string merge = slurm_merge_script(sweep);
  if (arguments.print) {
    fmt::print("{}\n{}", shards, merge);
    return kExitOk;
  }
  require_writable({{"--out", sweep.out / "shards.sh", FileKind::job_script, true},
                    {"--out", sweep.out / "merge.sh", FileKind::job_script, true}});
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
  reads(command,
        add(command,
            "--header FILE",
            a.header,
            "File with lines for both scripts: #SBATCH options (time, memory, partition), then "
            "commands before the run (default: ~/.config/loopbench/slurm.sh)"));
  command.add_flag("--print", a.print, "Print the scripts without submitting them");
  add(command, "--out DIR", a.out, "Output folder (default: results/CONFIG)");
  add(command, "options", a.options, "After --: options of `run`, for example --only");
  declare_force(command);
  command.callback([arguments, &exit_code] { exit_code = submit(*arguments); });
}

}  // namespace loopbench::harness
