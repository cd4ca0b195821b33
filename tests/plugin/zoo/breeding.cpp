/// Methods that start or signal other processes.
#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>

#include "tests/plugin/zoo/beast.hpp"

namespace loopbench::zoo {
namespace {

/// The name by which the test finds processes that are left.
[[noreturn]] void stray() {
  prctl(PR_SET_NAME, "zoo_stray");
  for (;;) pause();
}

BEAST(leave_child) {
  if (fork() == 0) stray();
}
/// In a session of their own, out of reach of signals to the group, with parents that have ended.
BEAST(leave_grandchildren) {
  for (int i = 0; i < 5; ++i) {
    if (fork() != 0) continue;
    setsid();
    if (fork() == 0) {
      setsid();
      stray();
    }
    _exit(0);
  }
}
BEAST(linger) {
  leave_grandchildren(scene);
  for (;;) pause();
}
/// Bounded, in case nothing else ends it.
BEAST(fork_bomb) {
  for (int i = 0; i < 400; ++i) {
    if (fork() == 0) stray();
  }
  stray();
}
BEAST(kill_parent) { kill(getppid(), SIGKILL); }
BEAST(stop_parent) { kill(getppid(), SIGSTOP); }
BEAST(kill_group) { kill(0, SIGKILL); }

}  // namespace
}  // namespace loopbench::zoo
