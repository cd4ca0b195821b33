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

void spin(const Scene&) {
  for (std::atomic<unsigned> turns = 0;; ++turns) {
  }
}
/// A program that inherits all descriptors that are not closed on exec.
void sleep_in_shell(const Scene&) {
  if (std::system("exec sleep 1000") != 0) wait_for_ever();
}
void close_all_and_wait(const Scene&) {
  for (int file = 0; file < 1024; ++file) close(file);
  wait_for_ever();
}
void block_signals_and_wait(const Scene&) {
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_SETMASK, &all, nullptr);
  wait_for_ever();
}
/// Honest, but slow.
void nap(const Scene&) { usleep(500000); }
void stop_itself(const Scene&) { raise(SIGSTOP); }

}  // namespace

std::vector<methods::MethodEntry> hanging() {
  return {beast<spin>("spin"),
          beast<sleep_in_shell>("sleep_in_shell"),
          beast<close_all_and_wait>("close_all_and_wait"),
          beast<block_signals_and_wait>("block_signals_and_wait"),
          beast<stop_itself>("stop_itself"),
          beast<nap>("nap")};
}

}  // namespace loopbench::zoo
