/// Runs the real binary on a terminal of a given width.
#pragma once

#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <vector>

#include "tests/support/command.hpp"

namespace loopbench {

/// `loopbench ARGUMENTS` through a shell in `folder`, on a pseudo-terminal with `columns` columns.
/// Its output contains standard error, and line ends as "\n".
inline CommandResult terminal_command(const std::string& arguments,
                                      const TemporaryFolder& folder,
                                      std::size_t columns,
                                      const std::string& environment = "TERM=xterm") {
  const std::string line = "cd '" + folder.path().string() + "' && env -u NO_COLOR " + environment +
                           " '" LOOPBENCH_BINARY "' " + arguments;
  winsize size{};
  size.ws_col = static_cast<unsigned short>(columns);
  size.ws_row = 50;
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, &size);
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    _exit(127);
  }
  CommandResult out;
  std::array<char, 4096> buffer;
  for (;;) {
    const ssize_t got = read(terminal, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;  // EIO once the program has ended
    out.out.append(buffer.data(), static_cast<std::size_t>(got));
  }
  close(terminal);
  int status = 0;
  waitpid(child, &status, 0);
  out.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  std::erase(out.out, '\r');
  return out;
}

}  // namespace loopbench
