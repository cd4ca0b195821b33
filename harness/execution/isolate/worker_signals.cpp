#include "harness/execution/isolate/worker_signals.hpp"

#include <poll.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <ctime>

namespace loopbench::harness {
namespace {

volatile std::sig_atomic_t running_cell = 0;
volatile std::sig_atomic_t is_continued = 0;
volatile std::sig_atomic_t socket_to_sweep = -1;

/// Waits in the handler, so that loading pauses as well, and the worker still notices the end of
/// the sweep. SIGCONT is blocked except while it waits, so that it cannot come too early.
void stop_with_cell(int) {
  const int error = errno;
  const pid_t cell = running_cell;
  if (cell > 0) kill(-cell, SIGSTOP);
  sigset_t waiting;
  sigprocmask(SIG_BLOCK, nullptr, &waiting);
  sigdelset(&waiting, SIGCONT);
  is_continued = 0;
  while (is_continued == 0 && !has_sweep_ended()) {
    pollfd sweep{socket_to_sweep, 0, 0};
    const timespec second{1, 0};
    ppoll(&sweep, 1, &second, &waiting);
  }
  if (cell > 0) kill(-cell, SIGCONT);
  errno = error;
}

constexpr std::array kHandledSignals{SIGINT, SIGTERM, SIGHUP, SIGTSTP, SIGCONT};

void set_action(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  if (signal == SIGTSTP) sigaddset(&action.sa_mask, SIGCONT);
  sigaction(signal, &action, nullptr);
}

}  // namespace

void install_worker_signals(int sweep) {
  socket_to_sweep = sweep;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) set_action(signal, [](int) {});
  set_action(SIGTSTP, stop_with_cell);
  set_action(SIGCONT, [](int) { is_continued = 1; });
}

void set_running_cell(pid_t group) { running_cell = group; }

void restore_default_signals() {
  for (const int signal : kHandledSignals) set_action(signal, SIG_DFL);
}

bool has_sweep_ended() {
  pollfd sweep{socket_to_sweep, 0, 0};
  return poll(&sweep, 1, 0) > 0 && (sweep.revents & (POLLHUP | POLLERR)) != 0;
}

}  // namespace loopbench::harness
