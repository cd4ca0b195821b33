#include "harness/plot/run_filter.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <thread>

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
  throw std::system_error(reason, std::generic_category());
}

/// Stops early if the program ends. Blocks SIGPIPE: call it on a thread of
/// its own, which takes a pending signal with it.
void send_all_to(Descriptor& out, const std::string& input) {
  sigset_t broken_pipe;
  sigemptyset(&broken_pipe);
  sigaddset(&broken_pipe, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &broken_pipe, nullptr);
  for (std::size_t done = 0; done < input.size();) {
    const ssize_t count = ::write(out.number, input.data() + done, input.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  out.close_now();
}

pid_t start(const std::vector<std::string>& words, int in, int out) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
  pid_t process = 0;
  const int reason =
      posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
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

FilterResult run_filter(const std::vector<std::string>& words, const std::string& input) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail_to_start(errno);
  Descriptor input_end{ends[0]};
  Descriptor to_program{ends[1]};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail_to_start(errno);
  Descriptor from_program{ends[0]};
  Descriptor output_end{ends[1]};
  const pid_t process = start(words, input_end.number, output_end.number);
  input_end.close_now();
  output_end.close_now();
  std::thread sender([&] { send_all_to(to_program, input); });
  FilterResult out;
  out.output = read_until_end(from_program.number);
  sender.join();
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  out.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return out;
}

}  // namespace loopbench::harness
