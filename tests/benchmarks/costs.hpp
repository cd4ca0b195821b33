/// Processor time (user and system) of parts of this process and of other programs.
#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace loopbench::test {

inline double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

inline double cpu_of(int who) {
  rusage usage{};
  getrusage(who, &usage);
  return seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
}

/// Of all threads of this process, for one of as many calls as take 20 ms [s].
inline double cpu_of(const std::function<void()>& work) {
  constexpr double kLeast = 0.02;
  const double begin = cpu_of(RUSAGE_SELF);
  for (int calls = 1;; ++calls) {
    work();
    const double took = cpu_of(RUSAGE_SELF) - begin;
    if (took >= kLeast) return took / calls;
  }
}

/// Of a program with all processes that it waits for [s]; its output is discarded. Throws if it
/// does not end with one of the exit codes 0 to `most`.
inline double cpu_of(const std::vector<std::string>& words, int most = 0) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawn(&child, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  int status = 0;
  rusage usage{};
  if (failed != 0 || wait4(child, &status, 0, &usage) != child || !WIFEXITED(status) ||
      WEXITSTATUS(status) > most) {
    std::string command;
    for (const std::string& word : words) command += word + " ";
    throw std::runtime_error("failed: " + command);
  }
  return seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
}

}  // namespace loopbench::test
