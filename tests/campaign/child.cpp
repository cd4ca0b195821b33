#include "tests/campaign/child.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace loopbench::campaign {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPause{2};

[[noreturn]] void execute(const std::vector<std::string>& words,
                          const std::filesystem::path& output,
                          std::uint64_t file_limit) {
  setpgid(0, 0);
  if (file_limit > 0) {
    ::signal(SIGXFSZ, SIG_IGN);  // writes fail, as on a full disk
    const rlimit limit{file_limit, file_limit};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  const int out = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  dup2(out, 1);
  dup2(out, 2);
  dup2(open("/dev/null", O_RDONLY), 0);
  closefrom(3);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  _exit(127);
}

std::string command_line(pid_t process) {
  std::ifstream in("/proc/" + std::to_string(process) + "/cmdline", std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();  // does not throw if the process ends
  std::string out = text.str();
  for (char& c : out) {
    if (c == '\0') c = ' ';
  }
  return std::to_string(process) + " " + out;
}

}  // namespace

Child::Child(const std::vector<std::string>& words,
             const std::filesystem::path& output,
             std::uint64_t file_limit)
    : id_(fork()) {
  if (id_ < 0) throw std::runtime_error("cannot start a process");
  if (id_ == 0) execute(words, output, file_limit);
  setpgid(id_, id_);  // in both, whichever runs first
}

Child::~Child() {
  if (ended_) return;
  signal_group(SIGKILL);
  waitpid(id_, nullptr, 0);
}

void Child::signal(int number) const { ::kill(id_, number); }
void Child::signal_group(int number) const { ::kill(-id_, number); }

int Child::wait(std::chrono::milliseconds limit) {
  const auto end = Clock::now() + limit;
  int status = 0;
  while (waitpid(id_, &status, WNOHANG) == 0) {
    if (Clock::now() > end) {
      signal_group(SIGKILL);
      waitpid(id_, &status, 0);
      ended_ = true;
      return -1;
    }
    std::this_thread::sleep_for(kPause);
  }
  ended_ = true;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void adopt_orphans() { prctl(PR_SET_CHILD_SUBREAPER, 1); }

std::vector<std::string> left_processes(std::chrono::milliseconds limit) {
  const auto end = Clock::now() + limit;
  while (Clock::now() < end) {
    const pid_t ended = waitpid(-1, nullptr, WNOHANG);
    if (ended < 0) return {};
    if (ended == 0) std::this_thread::sleep_for(kPause);
  }
  std::vector<std::string> out;
  for (const pid_t process : children_of(getpid())) {
    out.push_back(command_line(process));
    ::kill(process, SIGKILL);
    waitpid(process, nullptr, 0);
  }
  return out;
}

std::vector<pid_t> children_of(pid_t process) {
  const std::string id = std::to_string(process);
  std::ifstream in("/proc/" + id + "/task/" + id + "/children");
  return {std::istream_iterator<pid_t>(in), {}};
}

}  // namespace loopbench::campaign
