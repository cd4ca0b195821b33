/// Tries what would change this process for ever.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

namespace loopbench::harness {

/// Whether `work` returns true in a process of its own.
template <class Work>
bool try_in_child(const Work& work) {
  const pid_t child = fork();
  if (child == 0) _exit(work() ? 0 : 1);
  int status = 1;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace loopbench::harness
