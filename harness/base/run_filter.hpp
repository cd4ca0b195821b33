/// Runs a program that reads its standard input and writes its standard output.
#pragma once

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "harness/base/child_process.hpp"

namespace loopbench::harness {

struct FilterResult {
  int exit_code = 0;   ///< 128 + signal number if a signal ended it
  std::string output;  ///< of its standard output; standard error is ours
};

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

/// Stops early if the program ends.
inline void send_all_to(int descriptor, const std::string& input) {
  for (std::size_t done = 0; done < input.size();) {
    const ssize_t count =
        ::send(descriptor, input.data() + done, input.size() - done, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  ::shutdown(descriptor, SHUT_WR);
}

inline std::string read_until_end(int descriptor) {
  std::string out;
  std::array<char, 65536> block;
  while (true) {
    const ssize_t count = ::read(descriptor, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return out;
    out.append(block.data(), static_cast<std::size_t>(count));
  }
}

/// Starts `words` (searched in PATH, without a shell) and sends `input` while it reads the output,
/// so neither blocks. Throws std::system_error if the program cannot be started.
inline FilterResult run_filter(const std::vector<std::string>& words, const std::string& input) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw std::system_error(errno, std::generic_category());
  }
  const Descriptor ours{ends[0]};
  Descriptor theirs{ends[1]};
  ProgramCall call;
  call.arguments = words;
  call.input = theirs.number;
  call.output = theirs.number;
  ChildProcess process(ProcessGroup::shared, call);
  theirs.close_now();
  std::thread sender([&] { send_all_to(ours.number, input); });
  FilterResult out;
  out.output = read_until_end(ours.number);
  sender.join();
  out.exit_code = process.exit_code();
  return out;
}

}  // namespace loopbench::harness
