/// Scripts that run the shards of a sweep.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/cluster/settings.hpp"

namespace loopbench::harness {

struct SubmittedSweep {
  std::string name;               ///< of the sweep, any text
  std::filesystem::path program;  ///< absolute paths, here and below
  std::filesystem::path config;
  std::filesystem::path out;         ///< folder of the merged store
  std::vector<std::string> options;  ///< further words of `loopbench run`
};

/// Script of the array job: task I runs shard I. Ends its shard at the signal before the time limit
/// and requeues itself, which costs only the unfinished cells. All texts are quoted for the shell.
std::string slurm_shard_script(const SubmittedSweep& sweep, const ClusterSettings& settings);

/// Script of the job that merges the stores of all shards.
std::string slurm_merge_script(const SubmittedSweep& sweep, const ClusterSettings& settings);

/// Script that runs all shards as processes of this machine, then merges them.
std::string local_script(const SubmittedSweep& sweep, const ClusterSettings& settings);

/// The name with letters, digits, '.', '_' and '-' only, at most 60 characters.
std::string job_name(const std::string& name);

}  // namespace loopbench::harness
