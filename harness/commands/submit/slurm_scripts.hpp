/// Scripts that run the shards of a sweep as jobs of Slurm.
#pragma once

#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/sweep/process/shell.hpp"

namespace loopbench::harness {

struct SlurmSweep {
  std::string name;               ///< of the jobs, any text
  std::filesystem::path program;  ///< absolute paths, here and below
  std::filesystem::path config;
  std::filesystem::path out;         ///< folder of the merged store
  int shards = 1;                    ///< tasks of the array job
  std::vector<std::string> options;  ///< further words of `loopbench run`
  std::string header;                ///< lines of the user: `#SBATCH ...`, then commands
};

/// The name with letters, digits, '.', '_' and '-' only: sbatch reads the rest of its line.
inline std::string job_name(const std::string& name) {
  constexpr std::size_t kLongest = 50;
  std::string out = name.substr(0, kLongest);
  for (char& c : out) {
    const bool is_plain =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_' || c == '-';
    if (!is_plain) c = '_';
  }
  return out.empty() ? "loopbench" : out;
}

/// The first lines of both scripts; the options of the header replace those above it.
inline std::string script_beginning(const SlurmSweep& sweep,
                                    const std::string& suffix,
                                    const std::string& log) {
  std::string out = fmt::format(
      "#!/bin/bash\n"
      "#SBATCH --job-name={}{}\n"
      "#SBATCH --output=logs/{}.txt\n"
      "#SBATCH --open-mode=append\n"
      "#SBATCH --requeue\n"
      "#SBATCH --nodes=1\n"
      "#SBATCH --ntasks=1\n",
      job_name(sweep.name),
      suffix,
      log);
  out += sweep.header;
  if (!out.ends_with('\n')) out += '\n';
  return out;
}

inline std::string quoted_words(const std::vector<std::string>& all) {
  std::string out;
  for (const std::string& word : all) out += (out.empty() ? "" : " ") + shell_quoted(word);
  return out;
}

/// Array job: task I runs shard I, and continues its store if it runs again. All texts but the
/// header are quoted for the shell.
inline std::string slurm_shard_script(const SlurmSweep& sweep) {
  std::vector<std::string> run{
      sweep.program.string(), "run", sweep.config.string(), "--out", sweep.out.string()};
  run.insert(run.end(), sweep.options.begin(), sweep.options.end());
  SlurmSweep array = sweep;
  array.header = fmt::format("#SBATCH --array=1-{}\n", sweep.shards) + sweep.header;
  return script_beginning(array, "", "%A_%a") +
         fmt::format(
             "# Task I runs shard I of {0}. A task that runs again continues its store.\n"
             "{1} --shard \"$SLURM_ARRAY_TASK_ID/{0}\" --jobs \"${{SLURM_CPUS_PER_TASK:-1}}\"\n"
             "code=$?\n"
             "((code == 1)) && exit 0  # failed cells are results, too\n"
             "exit \"$code\"\n",
             sweep.shards,
             quoted_words(run));
}

/// Job that merges the stores of all shards.
inline std::string slurm_merge_script(const SlurmSweep& sweep) {
  const std::string out = sweep.out.string();
  return script_beginning(sweep, "-merge", "%j-merge") +
         fmt::format(
             "# Merges the stores of all shards.\n"
             "shopt -s nullglob\n"
             "stores=({0}/shards/*/results.sqlite)\n"
             "((${{#stores[@]}})) || {{ echo 'loopbench: no shard has a store' >&2; exit 2; }}\n"
             "{1} merge --add \"${{stores[@]}}\" -o {0}\n",
             shell_quoted(out),
             shell_quoted(sweep.program.string()));
}

}  // namespace loopbench::harness
