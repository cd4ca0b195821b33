#include "harness/execution/sandbox/sandbox.hpp"

#include <sched.h>
#include <sys/prctl.h>
#include <unistd.h>

#include "harness/execution/sandbox/landlock.hpp"
#include "harness/execution/sandbox/system_file.hpp"
#include "harness/execution/sandbox/try_in_child.hpp"

namespace loopbench::harness {

Sandbox::Sandbox(const SandboxOptions& options, const std::vector<pid_t>& guarded)
    : enabled_(options.enabled) {
  if (!enabled_) return;
  landlock_ = landlock_rules(options.unreachable, options.writable);
  for_methods_ = system_call_filter(guarded, Privileges::of_methods);
  for_programs_ = system_call_filter(guarded, Privileges::of_programs);
}

Sandbox::~Sandbox() {
  if (landlock_ >= 0) close(landlock_);
}

void Sandbox::enter(Privileges privileges) const {
  if (!enabled_) return;
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  if (landlock_ >= 0) landlock_restrict(landlock_);
  drop_capabilities();
  prctl(PR_SET_DUMPABLE, 0, 0, 0, 0);  // hides /proc/PID/mem from programs that it starts
  restrict_system_calls(privileges == Privileges::of_methods ? for_methods_ : for_programs_);
}

bool enter_pid_namespace() {
  if (unshare(CLONE_NEWPID) == 0) {
    unshare(CLONE_NEWIPC);
    return true;
  }
  const std::string user = std::to_string(geteuid());
  const std::string group = std::to_string(getegid());
  if (unshare(CLONE_NEWUSER | CLONE_NEWPID) != 0) return false;
  write_system_file("/proc/self/setgroups", "deny");
  write_system_file("/proc/self/uid_map", user + " " + user + " 1");
  write_system_file("/proc/self/gid_map", group + " " + group + " 1");
  unshare(CLONE_NEWIPC);
  return true;
}

std::string sandbox_summary(const SandboxOptions& options) {
  const auto state = [&](bool available) { return options.enabled && available ? "on" : "off"; };
  return std::string("PID namespace ") +
         state(options.pid_namespace && try_in_child(enter_pid_namespace)) + ", Landlock " +
         state(landlock_version() > 0) + ", seccomp " + state(has_seccomp()) + ", cgroup v2 " +
         (options.groups == nullptr ? "off" : options.groups->summary());
}

}  // namespace loopbench::harness
