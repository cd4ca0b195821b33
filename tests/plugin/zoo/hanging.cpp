/// Methods that never return.
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>

#include "tests/plugin/zoo/beast.hpp"

namespace loopbench::zoo {
namespace {

[[noreturn]] void wait_for_ever() {
  for (;;) pause();
}

BEAST(spin) {
  for (std::atomic<unsigned> turns = 0;; ++turns) {
  }
}
/// A program that inherits all descriptors that are not closed on exec.
BEAST(sleep_in_shell) {
  if (std::system("exec sleep 1000") != 0) wait_for_ever();
}
BEAST(close_all_and_wait) {
  for (int file = 0; file < 1024; ++file) close(file);
  wait_for_ever();
}
BEAST(block_signals_and_wait) {
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_SETMASK, &all, nullptr);
  wait_for_ever();
}
/// Honest, but slow.
BEAST(nap) { usleep(500000); }
BEAST(stop_itself) { raise(SIGSTOP); }

}  // namespace
}  // namespace loopbench::zoo
