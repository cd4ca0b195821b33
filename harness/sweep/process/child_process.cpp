#include "harness/sweep/process/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "harness/sweep/process/system_file.hpp"

namespace loopbench::harness {
namespace {

/// Calls `start`, which returns an error, again while the system has too few processes.
template <class Start>
int start_when_possible(const Start& start) {
  constexpr int kMostAttempts = 100;
  constexpr useconds_t kPause = 100'000;  // [us]
  for (int attempt = 1;; ++attempt) {
    const int error = start();
    if (error != EAGAIN || attempt == kMostAttempts) return error;
    usleep(kPause);
  }
}

std::vector<char*> pointers(const std::vector<std::string>& texts) {
  std::vector<char*> out;
  for (const std::string& text : texts) out.push_back(const_cast<char*>(text.c_str()));
  out.push_back(nullptr);
  return out;
}

/// Wait status of a process that has ended but has not been waited for, in the last field of its
/// line: a process that is not its parent can only read that. 0 if it cannot be read.
int status_of_zombie(pid_t process) {
  const std::string line = read_system_file("/proc/" + std::to_string(process) + "/stat");
  const std::size_t last = line.find_last_of(' ');
  return last == std::string::npos ? 0 : std::atoi(line.c_str() + last);
}

}  // namespace

ChildProcess::ChildProcess(ProcessGroup group, const std::function<int()>& work)
    : group_(group), owner_(getpid()) {
  const int error = start_when_possible([&] {
    id_ = fork();
    return id_ < 0 ? errno : 0;
  });
  if (id_ == 0) {
    if (group_ == ProcessGroup::own) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (getppid() != owner_) _exit(1);  // the parent has ended in the meantime
      setpgid(0, 0);
    }
    const int code = work();
    std::fflush(stdout);
    _exit(code);
  }
  if (error != 0) throw std::system_error(error, std::generic_category(), "fork");
  if (group_ == ProcessGroup::own) setpgid(id_, id_);  // both do it, so that it is done for both
  open_descriptor();
}

ChildProcess::ChildProcess(ProcessGroup group, const ProgramCall& call)
    : group_(group), owner_(getpid()) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addchdir_np(&files, call.folder.c_str());
  if (call.input >= 0) {
    posix_spawn_file_actions_adddup2(&files, call.input, STDIN_FILENO);
  } else {
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  }
  if (call.output >= 0) posix_spawn_file_actions_adddup2(&files, call.output, STDOUT_FILENO);
  if (call.errors >= 0) posix_spawn_file_actions_adddup2(&files, call.errors, STDERR_FILENO);
  posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t signals;
  sigemptyset(&signals);
  posix_spawnattr_setsigmask(&attributes, &signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGCHLD, SIGXFSZ})
    sigaddset(&signals, signal);
  posix_spawnattr_setsigdefault(&attributes, &signals);
  const int leads = group == ProcessGroup::own ? POSIX_SPAWN_SETPGROUP : 0;
  const int flags = leads | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK;
  posix_spawnattr_setflags(&attributes, static_cast<short>(flags));
  const std::vector<char*> arguments = pointers(call.arguments);
  const std::vector<char*> variables = pointers(call.environment);
  char* const* environment = call.environment.empty() ? environ : variables.data();
  const int error = start_when_possible([&] {
    return posix_spawnp(&id_, arguments[0], &files, &attributes, arguments.data(), environment);
  });
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) throw std::system_error(error, std::generic_category());
  open_descriptor();
}

ChildProcess::~ChildProcess() {
  if (getpid() == owner_) end();
  if (descriptor_ >= 0) close(descriptor_);
}

void ChildProcess::open_descriptor() {
  descriptor_ = static_cast<int>(syscall(SYS_pidfd_open, id_, 0));  // closed on exec
  if (descriptor_ >= 0) return;
  const int error = errno;
  end();
  throw std::runtime_error(std::string("pidfd_open: ") + std::strerror(error));
}

bool ChildProcess::has_ended(int wait) const {
  pollfd process{descriptor_, POLLIN, 0};
  return id_ < 0 || poll(&process, 1, wait) > 0;
}

void ChildProcess::kill() const {
  if (id_ <= 0) return;
  if (group_ == ProcessGroup::own) ::kill(-id_, SIGKILL);  // also while it forks
  ::kill(id_, SIGKILL);
}

int ChildProcess::end(rusage* usage) {
  if (id_ < 0) return 0;
  if (getpid() != owner_) return status_of_zombie(id_);
  kill();
  int status = 0;
  while (wait4(id_, &status, 0, usage) < 0 && errno == EINTR) {
  }
  id_ = -1;
  return status;
}

int ChildProcess::exit_code() {
  while (!has_ended(-1)) {
  }
  const int status = end();
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string signal_name(int signal) {
  const char* name = sigabbrev_np(signal);
  return name == nullptr ? "signal " + std::to_string(signal) : "SIG" + std::string(name);
}

std::string end_text(int wait_status) {
  if (WIFEXITED(wait_status)) return "exited with code " + std::to_string(WEXITSTATUS(wait_status));
  return "was ended by " + signal_name(WTERMSIG(wait_status));
}

}  // namespace loopbench::harness
