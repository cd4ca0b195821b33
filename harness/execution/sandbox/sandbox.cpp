#include "harness/execution/sandbox/sandbox.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

#include "harness/execution/sandbox/landlock.hpp"
#include "harness/execution/sandbox/seccomp.hpp"

namespace loopbench::harness {
namespace {

void write_text(const char* path, const std::string& text) {
  const int file = open(path, O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  [[maybe_unused]] const ssize_t written = write(file, text.data(), text.size());
  close(file);
}

bool has_pid_namespaces() {
  const pid_t child = fork();
  if (child == 0) _exit(enter_pid_namespace() ? 0 : 1);
  int status = 1;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

Sandbox::Sandbox(const SandboxOptions& options, const std::vector<pid_t>& guarded)
    : enabled_(options.enabled), guarded_(guarded) {
  if (enabled_) landlock_ = landlock_rules(options.unreachable, options.writable);
}

Sandbox::~Sandbox() {
  if (landlock_ >= 0) close(landlock_);
}

void Sandbox::enter() const {
  if (!enabled_) return;
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  if (landlock_ >= 0) landlock_restrict(landlock_);
  drop_capabilities();
  prctl(PR_SET_DUMPABLE, 0, 0, 0, 0);  // hides /proc/PID/mem from programs that it starts
  restrict_system_calls(guarded_);
}

bool enter_pid_namespace() {
  if (unshare(CLONE_NEWPID) == 0) return true;
  const std::string user = std::to_string(geteuid());
  const std::string group = std::to_string(getegid());
  if (unshare(CLONE_NEWUSER | CLONE_NEWPID) != 0) return false;
  write_text("/proc/self/setgroups", "deny");
  write_text("/proc/self/uid_map", user + " " + user + " 1");
  write_text("/proc/self/gid_map", group + " " + group + " 1");
  return true;
}

std::string sandbox_summary(const SandboxOptions& options) {
  const auto state = [&](bool available) { return options.enabled && available ? "on" : "off"; };
  return std::string("PID namespace ") + state(options.pid_namespace && has_pid_namespaces()) +
         ", Landlock " + state(landlock_version() > 0) + ", seccomp " + state(has_seccomp()) +
         ", cgroup v2 " + (options.groups == nullptr ? "off" : options.groups->summary());
}

}  // namespace loopbench::harness
