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

void leave_child(const Scene&) {
  if (fork() == 0) stray();
}
/// In a session of their own, out of reach of signals to the group, with parents that have ended.
void leave_grandchildren(const Scene&) {
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
void linger(const Scene& scene) {
  leave_grandchildren(scene);
  for (;;) pause();
}
/// Bounded, in case nothing else ends it.
void fork_bomb(const Scene&) {
  for (int i = 0; i < 400; ++i) {
    if (fork() == 0) stray();
  }
  stray();
}
void kill_parent(const Scene&) { kill(getppid(), SIGKILL); }
void stop_parent(const Scene&) { kill(getppid(), SIGSTOP); }
void kill_group(const Scene&) { kill(0, SIGKILL); }

}  // namespace

std::vector<methods::MethodEntry> breeding() {
  return {beast<leave_child>("leave_child"),
          beast<leave_grandchildren>("leave_grandchildren"),
          beast<linger>("linger"),
          beast<fork_bomb>("fork_bomb"),
          beast<kill_parent>("kill_parent"),
          beast<stop_parent>("stop_parent"),
          beast<kill_group>("kill_group")};
}

}  // namespace loopbench::zoo
