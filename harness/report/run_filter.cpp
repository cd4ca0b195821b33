#include "harness/report/run_filter.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <thread>

#include "harness/base/child_process.hpp"

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
  ProgramCall call;
  call.arguments = words;
  call.input = input_end.number;
  call.output = output_end.number;
  ChildProcess process(ProcessGroup::shared, call);
  input_end.close_now();
  output_end.close_now();
  std::thread sender([&] { send_all_to(to_program, input); });
  FilterResult out;
  out.output = read_until_end(from_program.number);
  sender.join();
  out.exit_code = process.exit_code();
  return out;
}

}  // namespace loopbench::harness
