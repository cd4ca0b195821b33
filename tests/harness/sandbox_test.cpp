/// What a method can and cannot reach.
#include "harness/execution/sandbox/sandbox.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/msg.h>
#include <sys/resource.h>
#include <sys/sem.h>
#include <sys/shm.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <cerrno>
#include <functional>
#include <initializer_list>
#include <thread>

#include "harness/execution/sandbox/landlock.hpp"
#include "harness/execution/sandbox/seccomp.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::sandbox_test {

using namespace harness;

namespace {

/// Exit code of `work` in a sandbox, in a process of its own.
int in_sandbox(const SandboxOptions& options,
               const std::function<int()>& work,
               Privileges privileges = Privileges::of_programs) {
  const Sandbox sandbox(options, {getpid()});
  const pid_t child = fork();
  if (child == 0) {
    sandbox.enter(privileges);
    _exit(work());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int error_of(long result) { return result < 0 ? errno : 0; }

class Sandboxed : public testing::Test {
 protected:
  std::string file(const std::string& name) {
    folder_.file(name, "text");
    return (folder_.path() / name).string();
  }
  static int read_error(const std::string& path) { return error_of(open(path.c_str(), O_RDONLY)); }
  static int write_error(const std::string& path) {
    return error_of(open(path.c_str(), O_WRONLY | O_CREAT, 0600));
  }

  TemporaryFolder folder_;
};

TEST_F(Sandboxed, FilesAreReadableExceptUnreachableOnesAndWritableNowhere) {
  if (landlock_version() == 0) GTEST_SKIP() << "no Landlock";
  const std::string hidden = file("hidden.txt");
  const std::string shown = file("shown.txt");
  SandboxOptions options;
  options.unreachable = {hidden, folder_.path() / "not/there"};
  EXPECT_EQ(in_sandbox(options, [&] { return read_error(hidden); }), EACCES);
  EXPECT_EQ(in_sandbox(options, [&] { return read_error(shown); }), 0);
  EXPECT_EQ(in_sandbox(options, [&] { return write_error(shown); }), EACCES);
  EXPECT_EQ(in_sandbox(options, [&] { return write_error("/dev/null"); }), 0);
  EXPECT_EQ(in_sandbox(options, [&] { return error_of(unlink(shown.c_str())); }), EACCES);
}

TEST_F(Sandboxed, ResultsBesideAnUnreachablePathAreUnreachable) {
  if (landlock_version() == 0) GTEST_SKIP() << "no Landlock";
  for (const char* name : {"own", "other", "sharded/shards/1-of-2", "data/shards/1"}) {
    std::filesystem::create_directories(folder_.path() / name);
  }
  const std::string shown = file("data/shards/1/points");
  SandboxOptions options;
  options.unreachable = {folder_.path() / "own"};
  for (const char* name :
       {"results.sqlite", "other/results.sqlite", "sharded/shards/1-of-2/results.sqlite"}) {
    const std::string hidden = file(name);
    EXPECT_EQ(in_sandbox(options, [&] { return read_error(hidden); }), EACCES) << name;
  }
  EXPECT_EQ(in_sandbox(options, [&] { return read_error(shown); }), 0);
}

TEST_F(Sandboxed, AProgramCanBeStartedAndWriteIntoItsFolder) {
  if (landlock_version() == 0) GTEST_SKIP() << "no Landlock";
  const std::string outside = file("outside.txt");
  std::filesystem::create_directory(folder_.path() / "own");
  SandboxOptions options;
  options.writable = {folder_.path() / "own"};
  const std::string own = (folder_.path() / "own/new.txt").string();
  const auto shell = [&](const std::string& line) {
    return in_sandbox(options, [&] {
      execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
      return 99;
    });
  };
  EXPECT_EQ(shell("echo new > '" + own + "' && rm '" + own + "'"), 0);
  EXPECT_NE(shell("echo new > '" + outside + "' 2>/dev/null"), 0);
}

TEST_F(Sandboxed, NetworkSocketsAreRefusedAndLocalOnesToMethodsOnly) {
  if (!has_seccomp()) GTEST_SKIP() << "no seccomp";
  for (const int family : {AF_INET, AF_INET6, AF_PACKET, AF_NETLINK}) {
    EXPECT_EQ(in_sandbox({}, [&] { return error_of(socket(family, SOCK_DGRAM, 0)); }), EPERM);
  }
  const auto local = [] { return error_of(socket(AF_UNIX, SOCK_STREAM, 0)); };
  EXPECT_EQ(in_sandbox({}, local, Privileges::of_methods), EPERM);
  EXPECT_EQ(in_sandbox({}, local, Privileges::of_programs), 0);
}

TEST_F(Sandboxed, MemoryAndMessagesThatOutliveACellAreRefused) {
  if (!has_seccomp()) GTEST_SKIP() << "no seccomp";
  const auto shared_memory = [] { return error_of(shmget(IPC_PRIVATE, 4096, IPC_CREAT | 0600)); };
  EXPECT_EQ(in_sandbox({}, shared_memory), EPERM);
  EXPECT_EQ(in_sandbox({}, [] { return error_of(msgget(IPC_PRIVATE, IPC_CREAT)); }), EPERM);
  EXPECT_EQ(in_sandbox({}, [] { return error_of(semget(IPC_PRIVATE, 1, IPC_CREAT)); }), EPERM);
  const auto queue = [] {
    return error_of(syscall(SYS_mq_open, "loopbench_test", O_CREAT | O_RDWR, 0600, nullptr));
  };
  EXPECT_EQ(in_sandbox({}, queue), EPERM);
}

TEST_F(Sandboxed, NewNamespacesAreRefusedAndThreadsAreNot) {
  if (!has_seccomp()) GTEST_SKIP() << "no seccomp";
  EXPECT_EQ(in_sandbox({}, [] { return error_of(unshare(CLONE_NEWUSER)); }), EPERM);
  const auto cloned = [] {
    const long child = syscall(SYS_clone, CLONE_NEWUSER | SIGCHLD, nullptr, nullptr, nullptr, 0);
    if (child == 0) _exit(0);
    return error_of(child);
  };
  EXPECT_EQ(in_sandbox({}, cloned), EPERM);
  EXPECT_EQ(in_sandbox({}, [] { return error_of(syscall(SYS_clone3, nullptr, 0)); }), ENOSYS);
  const auto thread = [] {
    int out = 1;
    std::thread([&] { out = 0; }).join();
    return out;
  };
  EXPECT_EQ(in_sandbox({}, thread), 0);
}

TEST_F(Sandboxed, OnlyProgramsChangeModesAndTimesOfFiles) {
  if (!has_seccomp()) GTEST_SKIP() << "no seccomp";
  const std::string reference = file("reference.txt");
  const auto mode = [&] { return error_of(chmod(reference.c_str(), 0600)); };
  const auto times = [&] { return error_of(utimensat(AT_FDCWD, reference.c_str(), nullptr, 0)); };
  const auto owner = [&] { return error_of(chown(reference.c_str(), getuid(), getgid())); };
  const auto attribute = [&] { return error_of(setxattr(reference.c_str(), "user.x", "x", 1, 0)); };
  const auto open_file = [&] { return error_of(fchmod(open(reference.c_str(), O_RDONLY), 0600)); };
  for (const std::function<int()>& change :
       std::initializer_list<std::function<int()>>{mode, times, owner, attribute, open_file}) {
    EXPECT_EQ(in_sandbox({}, change, Privileges::of_methods), EPERM);
  }
  EXPECT_EQ(in_sandbox({}, mode), 0);
  EXPECT_EQ(in_sandbox({}, times), 0);
}

TEST_F(Sandboxed, GuardedProcessesCannotBeSignalled) {
  if (!has_seccomp()) GTEST_SKIP() << "no seccomp";
  EXPECT_EQ(in_sandbox({}, [] { return error_of(kill(getppid(), 0)); }), EPERM);
  EXPECT_EQ(in_sandbox({}, [] { return error_of(kill(getpid(), 0)); }), 0);
  // A child of its own can be ended.
  EXPECT_EQ(in_sandbox({},
                       [] {
                         const pid_t child = fork();
                         if (child == 0) {
                           for (;;) pause();
                         }
                         return error_of(kill(child, SIGKILL));
                       }),
            0);
}

TEST_F(Sandboxed, GuardedProcessesCannotBeSlowedDown) {
  if (!has_seccomp()) GTEST_SKIP() << "no seccomp";
  const auto priority = [](int which, pid_t who) {
    return [=] {
      return error_of(setpriority(static_cast<__priority_which>(which), static_cast<id_t>(who), 1));
    };
  };
  const auto core_of = [](pid_t process) {
    cpu_set_t cores;
    sched_getaffinity(process, sizeof cores, &cores);
    return error_of(sched_setaffinity(process, sizeof cores, &cores));
  };
  EXPECT_EQ(in_sandbox({}, priority(PRIO_PROCESS, getpid())), EPERM);
  EXPECT_EQ(in_sandbox({}, priority(PRIO_PGRP, 0)), EPERM);
  EXPECT_EQ(in_sandbox({}, priority(PRIO_USER, 0)), EPERM);
  EXPECT_EQ(in_sandbox({}, priority(PRIO_PROCESS, 0)), 0);
  EXPECT_EQ(in_sandbox({}, [&] { return core_of(getppid()); }), EPERM);
  EXPECT_EQ(in_sandbox({}, [&] { return core_of(0); }), 0);
  EXPECT_EQ(in_sandbox({},
                       [] {
                         const sched_param parameters{};
                         return error_of(sched_setscheduler(getppid(), SCHED_IDLE, &parameters));
                       }),
            EPERM);
}

TEST_F(Sandboxed, AFolderOfProcIsNoDescriptorForSignals) {
  if (!has_seccomp()) GTEST_SKIP() << "no seccomp";
  const auto signal_parent = [] {
    const std::string parent = "/proc/" + std::to_string(getppid());
    const int descriptor = open(parent.c_str(), O_RDONLY | O_DIRECTORY);
    return error_of(syscall(SYS_pidfd_send_signal, descriptor, 0, nullptr, 0));
  };
  EXPECT_EQ(in_sandbox({}, signal_parent), ENOSYS);
}

TEST_F(Sandboxed, MemoryIsOutOfReachOfProcessesThatItStarts) {
  const auto error_in_child = [] {
    const std::string memory = "/proc/" + std::to_string(getpid()) + "/mem";
    const pid_t child = fork();
    if (child == 0) _exit(read_error(memory));
    int status = 0;
    waitpid(child, &status, 0);
    return WEXITSTATUS(status);
  };
  EXPECT_EQ(in_sandbox({}, error_in_child), EACCES);
}

TEST_F(Sandboxed, NothingIsRestrictedIfItIsOff) {
  SandboxOptions options;
  options.enabled = false;
  const std::string shown = file("shown.txt");
  EXPECT_EQ(in_sandbox(options, [&] { return write_error(shown); }), 0);
  EXPECT_EQ(sandbox_summary(options),
            "PID namespace off, Landlock off, seccomp off, cgroup v2 off");
}

}  // namespace
}  // namespace loopbench::sandbox_test
