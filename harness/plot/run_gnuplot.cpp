#include "harness/plot/run_gnuplot.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <thread>

#include "datasets/core/error.hpp"

namespace loopbench::harness {
namespace {

struct Descriptor {
  explicit Descriptor(int descriptor) : number(descriptor) {}
  ~Descriptor() { close_now(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  void close_now() {
    if (number >= 0) ::close(number);
    number = -1;
  }
  int number;
};

[[noreturn]] void fail_to_start(int reason) {
  if (reason == ENOENT) throw InputError("gnuplot is not installed (package gnuplot-nox)");
  throw InputError(std::string("gnuplot cannot be started: ") + std::strerror(reason));
}

/// Stops early if gnuplot ends, which has then reported why. Blocks SIGPIPE: call it on a thread of
/// its own, which takes a pending signal with it.
void send_all_to(Descriptor& out, const std::string& script) {
  sigset_t broken_pipe;
  sigemptyset(&broken_pipe);
  sigaddset(&broken_pipe, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &broken_pipe, nullptr);
  for (std::size_t done = 0; done < script.size();) {
    const ssize_t count = ::write(out.number, script.data() + done, script.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  out.close_now();
}

pid_t start_gnuplot(int in, int out) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
  char name[] = "gnuplot";
  char script[] = "/dev/stdin";  // opened by name it is read in blocks, otherwise byte by byte
  char* const arguments[] = {name, script, nullptr};
  pid_t process = 0;
  const int reason = posix_spawnp(&process, name, &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (reason != 0) fail_to_start(reason);
  return process;
}

std::string read_until_end(int descriptor) {
  std::string out;
  std::array<char, 65536> block;
  while (true) {
    const ssize_t count = ::read(descriptor, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return out;
    out.append(block.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace

std::string drawn_by_gnuplot(const std::string& script) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail_to_start(errno);
  Descriptor script_end{ends[0]};
  Descriptor to_gnuplot{ends[1]};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail_to_start(errno);
  Descriptor from_gnuplot{ends[0]};
  Descriptor drawing_end{ends[1]};
  const pid_t process = start_gnuplot(script_end.number, drawing_end.number);
  script_end.close_now();
  drawing_end.close_now();
  // In parallel: gnuplot draws before it has read all.
  std::thread sender([&] { send_all_to(to_gnuplot, script); });
  const std::string out = read_until_end(from_gnuplot.number);
  sender.join();
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (status == 0 && !out.empty()) return out;
  throw InputError("gnuplot failed (package gnuplot-nox); its messages are above");
}

}  // namespace loopbench::harness
