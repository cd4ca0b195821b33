/// Record of a submitted sweep, in its output folder.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "harness/cluster/settings.hpp"

namespace loopbench::harness {

struct Submission {
  Engine engine = Engine::slurm;
  std::size_t cells = 0;  ///< of the sweep
  std::size_t shards = 0;
  std::string job;        ///< Slurm's number of the array job
  std::string merge_job;  ///< of the job that depends on it
  pid_t process = 0;      ///< local: leader of the process group
  std::string started;    ///< local: see start_of_process()
};

/// Writes OUT/submission.txt, "NAME VALUE" lines. Throws InputError.
void write_submission(const Submission& submission, const std::filesystem::path& out);

/// Throws InputError if there is none, or it is not valid.
Submission read_submission(const std::filesystem::path& out);

/// Whether the processes of a local submission are running.
bool is_running(const Submission& submission);

/// "4 running, 2 pending": the array tasks and the merge as squeue lists them; empty if no job is
/// left; nullopt if squeue fails, for example while the controller restarts. Throws InputError if
/// it cannot be started.
std::optional<std::string> queued_tasks(const Submission& submission);

/// "6 completed, 1 failed": ended jobs as sacct lists them; empty without accounting.
std::string ended_tasks(const Submission& submission);

/// Ends all jobs or processes. Throws InputError if scancel fails.
void cancel(const Submission& submission);

}  // namespace loopbench::harness
