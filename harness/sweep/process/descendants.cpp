#include "harness/sweep/process/descendants.hpp"

#include <dirent.h>
#include <linux/magic.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/statfs.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "harness/sweep/process/system_file.hpp"

namespace loopbench::harness {
namespace {

void append_children(const std::string& thread, std::vector<pid_t>& out) {
  const std::string text = read_system_file(thread + "/children");
  const char* at = text.c_str();
  for (;;) {
    char* end = nullptr;
    const long process = std::strtol(at, &end, 10);
    if (end == at) return;
    out.push_back(static_cast<pid_t>(process));
    at = end;
  }
}

void append_children_of_process(pid_t process, std::vector<pid_t>& out) {
  const std::string threads = "/proc/" + std::to_string(process) + "/task";
  DIR* folder = opendir(threads.c_str());
  if (folder == nullptr) return;
  while (const dirent* entry = readdir(folder)) {
    if (entry->d_name[0] != '.') append_children(threads + "/" + entry->d_name, out);
  }
  closedir(folder);
}

/// Calls visit(number as text) for processes and their descendants, until it returns false.
template <class Visit>
void for_each_in_tree(std::vector<pid_t> waiting, Visit visit) {
  while (!waiting.empty()) {
    const pid_t next = waiting.back();
    waiting.pop_back();
    if (!visit(std::to_string(next))) return;
    append_children_of_process(next, waiting);
  }
}

/// Files of tmpfs, also those of memfd_create(), which are no memory of any process unless mapped.
/// Each counts once.
class MemoryFiles {
 public:
  std::int64_t bytes() const { return bytes_; }

  /// All in a folder.
  void add_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::recursive_directory_iterator entry(folder, error);
    for (; entry != std::filesystem::recursive_directory_iterator(); entry.increment(error)) {
      add_file(entry->path().string(), lstat);
      if (error) return;
    }
  }

  /// What the process has open, and in /dev/shm if that is not this process's.
  void add_process(const std::string& process) {
    add_own_shm("/proc/" + process + "/root/dev/shm");
    const std::string files = "/proc/" + process + "/fd/";
    DIR* folder = opendir(files.c_str());
    if (folder == nullptr) return;
    while (const dirent* entry = readdir(folder)) {
      if (entry->d_name[0] != '.') add_file(files + entry->d_name, stat);
    }
    closedir(folder);
  }

 private:
  using Stat = int(const char*, struct stat*);

  static bool is_in_memory(const std::string& path, struct statfs& system) {
    return statfs(path.c_str(), &system) == 0 && system.f_type == TMPFS_MAGIC;
  }

  void add_file(const std::string& path, Stat* read) {
    constexpr std::int64_t kBlock = 512;  // [bytes]
    struct stat file {};
    struct statfs system {};
    if (read(path.c_str(), &file) != 0 || !S_ISREG(file.st_mode)) return;
    if (systems_.contains(file.st_dev) || !is_in_memory(path, system)) return;
    if (files_.emplace(file.st_dev, file.st_ino).second) bytes_ += kBlock * file.st_blocks;
  }

  void add_own_shm(const std::string& path) {
    struct stat here {};
    struct stat there {};
    struct statfs system {};
    if (stat("/dev/shm", &here) != 0 || stat(path.c_str(), &there) != 0) return;
    if (here.st_dev == there.st_dev || !is_in_memory(path, system)) return;
    if (!systems_.insert(there.st_dev).second) return;
    bytes_ += static_cast<std::int64_t>(system.f_blocks - system.f_bfree) * system.f_bsize;
  }

  std::set<std::pair<dev_t, ino_t>> files_;
  std::set<dev_t> systems_;  ///< counted with all their files
  std::int64_t bytes_ = 0;
};

/// Shared memory of a process, with mapped files in memory [bytes].
std::int64_t shared_memory(const std::string& process) {
  return memory_in(read_system_file("/proc/" + process + "/status"), "RssShmem:").value_or(0);
}

/// Children of the calling thread, but those of `kept`.
std::vector<pid_t> own_children_except(const std::vector<pid_t>& kept) {
  std::vector<pid_t> out = own_children();
  std::erase_if(out, [&](pid_t child) { return std::ranges::count(kept, child) > 0; });
  return out;
}

TreeUsage usage_of(const std::vector<pid_t>& processes,
                   std::int64_t at_fork,
                   std::int64_t most_processes,
                   const std::filesystem::path& folder) {
  TreeUsage out;
  MemoryFiles files;
  std::int64_t shared = 0;
  if (!folder.empty()) files.add_folder(folder);
  for_each_in_tree(processes, [&](const std::string& each) {
    files.add_process(each);
    shared += shared_memory(each);
    out.memory += std::max<std::int64_t>(0, process_memory(each) - at_fork);
    return ++out.processes <= most_processes;
  });
  // Of the shared memory, it is not known which files it maps.
  out.memory += std::max<std::int64_t>(0, files.bytes() - shared);
  return out;
}

/// CPU time of a process and of the children that it waited for [s], the latter in the steps of
/// /proc/PROCESS/stat, usually 10 ms; so is its own if it has no clock.
double cpu_seconds_of(const std::string& process) {
  const std::string stat = read_system_file("/proc/" + process + "/stat");
  std::istringstream fields(stat.substr(std::min(stat.rfind(')') + 1, stat.size())));
  std::string skipped;
  for (int i = 0; i < 11; ++i) fields >> skipped;
  double user = 0.0, system = 0.0, children_user = 0.0, children_system = 0.0;
  fields >> user >> system >> children_user >> children_system;
  const auto second = static_cast<double>(sysconf(_SC_CLK_TCK));
  double own = (user + system) / second;
  clockid_t clock{};
  timespec used{};
  if (clock_getcpuclockid(std::stoi(process), &clock) == 0 && clock_gettime(clock, &used) == 0)
    own = static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
  return own + (children_user + children_system) / second;
}

}  // namespace

std::vector<pid_t> own_children() {
  std::vector<pid_t> out;
  append_children("/proc/thread-self", out);
  return out;
}

std::int64_t process_memory(const std::string& process) {
  const std::string status = read_system_file("/proc/" + process + "/status");
  return memory_in(status, "RssAnon:").value_or(0) + memory_in(status, "RssShmem:").value_or(0);
}

TreeUsage descendants_usage(std::int64_t at_fork,
                            std::int64_t most_processes,
                            const std::vector<pid_t>& keep_alive,
                            const std::filesystem::path& folder) {
  return usage_of(own_children_except(keep_alive), at_fork, most_processes, folder);
}

std::int64_t tree_memory(pid_t process) {
  return usage_of({process}, 0, std::numeric_limits<std::int64_t>::max(), {}).memory;
}

TreeCost tree_cost(pid_t process) {
  TreeCost out;
  for_each_in_tree({process}, [&](const std::string& each) {
    out.cpu_seconds += cpu_seconds_of(each);
    const std::string status = read_system_file("/proc/" + each + "/status");
    out.peak_memory = std::max(out.peak_memory, memory_in(status, "VmHWM:").value_or(0));
    return true;
  });
  return out;
}

void end_strays(const std::vector<pid_t>& keep_alive) {
  siginfo_t none;
  const int error = waitid(P_ALL, 0, &none, WEXITED | WNOHANG | WNOWAIT) == 0 ? 0 : errno;
  if (error == ECHILD) return;  // faster than reading the list
  for (;;) {
    const std::vector<pid_t> strays = own_children_except(keep_alive);
    if (strays.empty()) return;
    for (const pid_t stray : strays) kill(stray, SIGKILL);
    for (const pid_t stray : strays) {
      while (waitpid(stray, nullptr, 0) < 0 && errno == EINTR) {
      }
    }
  }
}

Subreaper::Subreaper() : others_(own_children()) {
  prctl(PR_GET_CHILD_SUBREAPER, &before_);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
}

Subreaper::~Subreaper() {
  end_strays(others_);
  prctl(PR_SET_CHILD_SUBREAPER, before_);
}

void Subreaper::end_strays_except(std::vector<pid_t> workers) const {
  workers.insert(workers.end(), others_.begin(), others_.end());
  end_strays(workers);
}

}  // namespace loopbench::harness
