/// Runs the real binary from the command line.
#pragma once

#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/support/has.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench {

struct CommandResult {
  int exit_code = -1;
  std::string out;
  std::string err;
};

inline std::string read_all(const std::filesystem::path& file) {
  const std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();  // does not throw if a file of /proc ends with its process
  return out.str();
}

/// `loopbench ARGUMENTS` through a shell, standard input closed, in `folder`.
inline CommandResult loopbench_command(const std::string& arguments,
                                       const TemporaryFolder& folder) {
  const std::filesystem::path out = folder.path() / ".out";
  const std::filesystem::path err = folder.path() / ".err";
  const std::string line = "cd '" + folder.path().string() + "' && '" LOOPBENCH_BINARY "' " +
                           arguments + " >'" + out.string() + "' 2>'" + err.string() +
                           "' </dev/null";
  const int status = std::system(line.c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {code, read_all(out), read_all(err)};
}

/// The same for a command that must succeed.
inline CommandResult successful_command(const std::string& arguments,
                                        const TemporaryFolder& folder) {
  CommandResult result = loopbench_command(arguments, folder);
  EXPECT_EQ(result.exit_code, 0) << arguments << "\n" << result.out << result.err;
  return result;
}

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

/// Whether figures can be drawn on this machine.
inline bool has_matplotlib() {
  static const bool found = std::system(
                                "python3 -c 'import matplotlib' 2>/dev/null || "
                                "/usr/bin/python3 -c 'import matplotlib' 2>/dev/null") == 0;
  return found;
}

}  // namespace loopbench
