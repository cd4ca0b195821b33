/// Descendants of this process, as listed in /proc.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace loopbench::harness {

/// Children of the calling thread, including adopted ones. Empty without /proc.
std::vector<pid_t> own_children();

struct TreeUsage {
  /// Private and shared memory beyond that at the fork, and files in memory that are not mapped:
  /// open ones, those in /dev/shm of a sandbox, those in a folder [bytes].
  std::int64_t memory = 0;
  std::int64_t processes = 0;  ///< at most one more than the limit
};

/// Usage of all descendants of the calling thread. Each counts with what it has beyond `at_fork`
/// bytes; `keep_alive` children do not count; a copy of a process that has grown before counts with
/// its growth again. Stops counting after `most_processes` of them. `folder`: for their temporary
/// files, which count if they are in memory; may be empty.
TreeUsage descendants_usage(std::int64_t at_fork,
                            std::int64_t most_processes,
                            const std::vector<pid_t>& keep_alive,
                            const std::filesystem::path& folder);

/// Memory of a process and all its descendants [bytes], see TreeUsage.
std::int64_t tree_memory(pid_t process);

struct TreeCost {
  double cpu_seconds = 0.0;      ///< of running processes and of those that they waited for [s]
  std::int64_t peak_memory = 0;  ///< largest resident size of one of the running ones [bytes]
};

/// What a process and its running descendants have used since their starts.
TreeCost tree_cost(pid_t process);

/// Private and shared memory of a process, or "self" [bytes]; without mapped files. 0 if unknown.
std::int64_t process_memory(const std::string& process);

/// In a subreaper: kills its children but those in `keep_alive`, with their descendants, and waits
/// for their end.
void end_strays(const std::vector<pid_t>& keep_alive);

/// While it exists, this process adopts descendants whose parents have ended. At the end it ends
/// all that remain.
class Subreaper {
 public:
  Subreaper();
  ~Subreaper();
  Subreaper(const Subreaper&) = delete;
  Subreaper& operator=(const Subreaper&) = delete;

  /// Ends all children but `workers` and those that were there before.
  void end_strays_except(std::vector<pid_t> workers) const;

 private:
  std::vector<pid_t> others_;  ///< children that were there before
  int before_ = 0;             ///< whether it was a subreaper
};

}  // namespace loopbench::harness
