#include "harness/external/supervisor.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace loopbench::harness {
namespace {

constexpr int kMemoryCheck = 20;                // [ms]
constexpr int kProcessCheck = 200;              // [ms], without a memory limit
constexpr std::chrono::seconds kLongestEnd{5};  // for processes that cannot be killed
constexpr int kFailedExec = 127;

std::string file_text(const std::string& name) {
  const int file = open(name.c_str(), O_RDONLY | O_CLOEXEC);
  std::string out;
  std::array<char, 4096> buffer{};
  while (file >= 0) {
    const ssize_t got = read(file, buffer.data(), buffer.size());
    if (got <= 0) break;
    out.append(buffer.data(), static_cast<std::size_t>(got));
  }
  if (file >= 0) close(file);
  return out;
}

/// Child processes of all threads of a process.
std::vector<pid_t> children_of(pid_t process) {
  const std::string tasks = "/proc/" + std::to_string(process) + "/task";
  std::vector<pid_t> out;
  DIR* folder = opendir(tasks.c_str());
  if (folder == nullptr) return out;
  while (const dirent* entry = readdir(folder)) {
    if (entry->d_name[0] == '.') continue;
    const std::string list = file_text(tasks + "/" + entry->d_name + "/children");
    const char* at = list.c_str();
    for (char* next = nullptr;; at = next) {
      const long child = std::strtol(at, &next, 10);
      if (next == at) break;
      out.push_back(static_cast<pid_t>(child));
    }
  }
  closedir(folder);
  return out;
}

struct TreeSize {
  std::int64_t memory = 0;     ///< resident size [bytes]
  std::int64_t processes = 0;  ///< at most one more than the limit
};

/// Size of all descendants.
TreeSize tree_size(pid_t process) {
  TreeSize out;
  std::vector<pid_t> waiting = children_of(process);
  while (!waiting.empty() && out.processes <= kMostProgramProcesses) {
    const pid_t child = waiting.back();
    waiting.pop_back();
    const std::string text = file_text("/proc/" + std::to_string(child) + "/statm");
    const std::size_t blank = std::min(text.find(' '), text.size());
    out.memory += std::strtoll(text.c_str() + blank, nullptr, 10) * sysconf(_SC_PAGESIZE);
    ++out.processes;
    const std::vector<pid_t> further = children_of(child);
    waiting.insert(waiting.end(), further.begin(), further.end());
  }
  return out;
}

/// Kills all descendants and reaps them; returns how many there were besides `program`, whose
/// status is stored if it had not ended before.
std::int64_t end_tree(pid_t program, bool& has_ended, int& status) {
  std::vector<pid_t> seen;
  const auto begin = std::chrono::steady_clock::now();
  kill(-program, SIGKILL);
  while (std::chrono::steady_clock::now() - begin < kLongestEnd) {
    for (const pid_t child : children_of(getpid())) {
      kill(child, SIGKILL);
      if (child != program && std::ranges::count(seen, child) == 0) seen.push_back(child);
    }
    int child_status = 0;
    const pid_t ended = waitpid(-1, &child_status, WNOHANG);
    if (ended < 0 && errno == ECHILD) break;
    if (ended == program) {
      has_ended = true;
      status = child_status;
    }
    if (ended == 0) usleep(200);
  }
  return static_cast<std::int64_t>(seen.size());
}

[[noreturn]] void execute(const ProgramStart& start,
                          const std::vector<std::string>& environment,
                          const SupervisorFiles& files,
                          int start_error) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // in case the supervisor is killed
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGCHLD}) std::signal(signal, SIG_DFL);
  const int input = files.input >= 0 ? files.input : open("/dev/null", O_RDONLY | O_CLOEXEC);
  dup2(input, STDIN_FILENO);
  dup2(files.output, STDOUT_FILENO);
  dup2(files.errors >= 0 ? files.errors : files.output, STDERR_FILENO);
  std::vector<char*> words;
  for (const std::string& word : start.arguments) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  std::vector<char*> variables;
  for (const std::string& each : environment) variables.push_back(const_cast<char*>(each.c_str()));
  variables.push_back(nullptr);
  if (chdir(start.folder.c_str()) == 0) execvpe(words[0], words.data(), variables.data());
  const int error = errno;
  [[maybe_unused]] const ssize_t written = write(start_error, &error, sizeof error);
  _exit(kFailedExec);
}

/// Closes everything but standard error and the given files.
void close_others(std::vector<int> keep) {
  keep.push_back(STDERR_FILENO);
  std::ranges::sort(keep);
  unsigned from = 0;
  for (const int file : keep) {
    if (file < 0) continue;
    const auto next = static_cast<unsigned>(file);
    if (next > from) close_range(from, next - 1, 0);
    from = next + 1;
  }
  close_range(from, ~0u, 0);
}

void remove_tree(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!folder.empty()) std::filesystem::remove_all(folder, ignored);
}

/// Waits until the program ends, exceeds a limit, or the other side closes the control pipe;
/// returns false in the last case.
bool watch(const ProgramStart& start,
           int control,
           int signals,
           pid_t program,
           ProgramEnd& end,
           bool& has_ended,
           int& status) {
  while (!has_ended && end.over_memory == 0 && end.over_processes == 0) {
    std::array<pollfd, 2> files{{{control, POLLIN, 0}, {signals, POLLIN, 0}}};
    poll(files.data(), files.size(), start.memory > 0 ? kMemoryCheck : kProcessCheck);
    if (files[0].revents != 0) return false;
    signalfd_siginfo info{};
    while (read(signals, &info, sizeof info) > 0) {
    }
    int child_status = 0;
    for (pid_t ended = 0; (ended = waitpid(-1, &child_status, WNOHANG)) > 0;) {
      if (ended != program) continue;
      has_ended = true;
      status = child_status;
    }
    if (has_ended) continue;
    const TreeSize size = tree_size(getpid());
    if (start.memory > 0 && size.memory > start.memory) end.over_memory = size.memory;
    if (size.processes > kMostProgramProcesses) end.over_processes = size.processes;
  }
  return true;
}

/// Bubblewrap exits with 128 + the signal that ended the program.
void restore_signal(ProgramEnd& end) {
  constexpr int kSignaled = 128;
  if (end.exit_code <= kSignaled || end.exit_code >= kSignaled + NSIG) return;
  end.signal = end.exit_code - kSignaled;
  end.exit_code = -1;
}

}  // namespace

void supervise(const ProgramStart& start,
               const std::vector<std::string>& environment,
               const SupervisorFiles& files) {
  setpgid(0, 0);  // signals of the terminal are for the sweep
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  std::signal(SIGPIPE, SIG_IGN);
  sigset_t child_ends;
  sigemptyset(&child_ends);
  sigaddset(&child_ends, SIGCHLD);
  sigprocmask(SIG_SETMASK, &child_ends, nullptr);
  std::signal(SIGCHLD, SIG_DFL);
  close_others({files.control, files.status, files.input, files.output, files.errors});
  const int signals = signalfd(-1, &child_ends, SFD_NONBLOCK | SFD_CLOEXEC);
  std::array<int, 2> start_error{-1, -1};
  ProgramEnd end;
  if (pipe2(start_error.data(), O_CLOEXEC) != 0) _exit(kFailedExec);
  const pid_t program = fork();
  if (program == 0) execute(start, environment, files, start_error[1]);
  if (program < 0) _exit(kFailedExec);
  for (const int file : {files.input, files.output, files.errors, start_error[1]}) close(file);

  bool has_ended = false;
  int status = 0;
  const bool is_wanted = watch(start, files.control, signals, program, end, has_ended, status);
  end.left_behind = end_tree(program, has_ended, status);
  if (start.sandbox != nullptr) end.left_behind = 0;  // they ended with their namespace
  if (read(start_error[0], &end.start_error, sizeof end.start_error) <= 0) end.start_error = 0;
  if (has_ended && WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (has_ended && WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  if (start.sandbox != nullptr) restore_signal(end);
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  end.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  end.peak_memory = std::int64_t{1024} * usage.ru_maxrss;
  if (is_wanted) {
    [[maybe_unused]] const ssize_t written = write(files.status, &end, sizeof end);
    std::array<pollfd, 1> released{{{files.control, POLLIN, 0}}};
    while (poll(released.data(), 1, -1) < 0 && errno == EINTR) {
    }
  }
  remove_tree(start.scratch);
  _exit(0);
}

}  // namespace loopbench::harness
