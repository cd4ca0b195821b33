/// Runs the real binary from the command line.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/has.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench {

struct CommandResult {
  int exit_code = -1;
  std::string out;
  std::string err;
};

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

}  // namespace loopbench
