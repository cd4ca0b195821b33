/// Scripts that run the shards of a sweep as jobs of Slurm.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

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

/// Array job: task I runs shard I, and continues its store if it runs again. All texts but the
/// header are quoted for the shell.
std::string slurm_shard_script(const SlurmSweep& sweep);

/// Job that merges the stores of all shards.
std::string slurm_merge_script(const SlurmSweep& sweep);

}  // namespace loopbench::harness
