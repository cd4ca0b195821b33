#include "harness/cluster/run_program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>

#include "datasets/core/error.hpp"

namespace loopbench::harness {
namespace {

constexpr int kCannotStart = 127;

std::vector<char*> arguments_of(const std::vector<std::string>& words) {
  std::vector<char*> out;
  for (const std::string& word : words) out.push_back(const_cast<char*>(word.c_str()));
  out.push_back(nullptr);
  return out;
}

/// In the child: only functions that are safe after fork.
[[noreturn]] void execute(char* const* arguments, const char* where, int in, int out, int error) {
  const bool is_ready = chdir(where) == 0 && dup2(in, STDIN_FILENO) >= 0 &&
                        dup2(out, STDOUT_FILENO) >= 0 && dup2(error, STDERR_FILENO) >= 0;
  if (is_ready) execvp(arguments[0], arguments);
  _exit(kCannotStart);
}

InputError cannot_start(const std::string& name) {
  return InputError(name + ": cannot be started: " + std::strerror(errno));
}

}  // namespace

ProgramResult run_program(const std::vector<std::string>& words,
                          const std::filesystem::path& where,
                          bool quiet) {
  std::fflush(nullptr);  // otherwise a failed child could print buffered output again
  const std::vector<char*> arguments = arguments_of(words);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw cannot_start(words[0]);
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  const pid_t process = fork();
  if (process == 0) {
    execute(arguments.data(), where.c_str(), nothing, ends[1], quiet ? nothing : STDERR_FILENO);
  }
  close(ends[1]);
  close(nothing);
  ProgramResult out;
  char block[4096];
  for (;;) {
    const ssize_t count = read(ends[0], block, sizeof block);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    out.out.append(block, static_cast<std::size_t>(count));
  }
  close(ends[0]);
  if (process < 0) throw cannot_start(words[0]);
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  out.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return out;
}

pid_t start_program(const std::vector<std::string>& words,
                    const std::filesystem::path& where,
                    const std::filesystem::path& log) {
  std::fflush(nullptr);
  const std::vector<char*> arguments = arguments_of(words);
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  const int out = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (out < 0) {
    throw InputError(log.string() + ": cannot be written: " + std::strerror(errno));
  }
  const pid_t process = fork();
  if (process == 0) {
    setsid();
    execute(arguments.data(), where.c_str(), nothing, out, out);
  }
  close(nothing);
  close(out);
  if (process < 0) throw cannot_start(words[0]);
  return process;
}

std::string start_of_process(pid_t process) {
  std::ifstream in("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(in, text, '\0');                  // does not throw if the process ends meanwhile
  const std::size_t name_end = text.rfind(')');  // the name can contain anything
  if (name_end == std::string::npos) return "";
  std::istringstream words(text.substr(name_end + 1));
  std::string out;
  constexpr int kStart = 20;  // the 22nd field
  for (int i = 0; i < kStart; ++i) words >> out;
  return out;
}

}  // namespace loopbench::harness
