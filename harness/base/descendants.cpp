#include "harness/base/descendants.hpp"

#include <dirent.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <sstream>

#include "harness/base/system_file.hpp"

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

/// Children of the calling thread, but those of `kept`.
std::vector<pid_t> own_children_except(const std::vector<pid_t>& kept) {
  std::vector<pid_t> out = own_children();
  std::erase_if(out, [&](pid_t child) { return std::ranges::count(kept, child) > 0; });
  return out;
}

/// The fields utime, stime, cutime and cstime, 12 to 15 after the name in parentheses, of the text
/// of /proc/PROCESS/stat [s].
double cpu_seconds_in(const std::string& stat) {
  std::istringstream fields(stat.substr(std::min(stat.rfind(')') + 1, stat.size())));
  std::string skipped;
  for (int i = 0; i < 11; ++i) fields >> skipped;
  double ticks = 0.0;
  double field = 0.0;
  for (int i = 0; i < 4 && fields >> field; ++i) ticks += field;
  return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
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
                            const std::vector<pid_t>& keep_alive) {
  TreeUsage out;
  for_each_in_tree(own_children_except(keep_alive), [&](const std::string& each) {
    out.memory += std::max<std::int64_t>(0, process_memory(each) - at_fork);
    return ++out.processes <= most_processes;
  });
  return out;
}

std::int64_t tree_memory(pid_t process) {
  std::int64_t out = 0;
  for_each_in_tree({process}, [&](const std::string& each) {
    out += process_memory(each);
    return true;
  });
  return out;
}

TreeCost tree_cost(pid_t process) {
  TreeCost out;
  for_each_in_tree({process}, [&](const std::string& each) {
    out.cpu_seconds += cpu_seconds_in(read_system_file("/proc/" + each + "/stat"));
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
