/// What a method can and cannot reach.
#include "harness/execution/sandbox/sandbox.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <functional>

#include "harness/execution/sandbox/landlock.hpp"
#include "harness/execution/sandbox/seccomp.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::sandbox_test {

using namespace harness;

namespace {

/// Exit code of `work` in a sandbox, in a process of its own.
int in_sandbox(const SandboxOptions& options, const std::function<int()>& work) {
  const Sandbox sandbox(options, {getpid()});
  const pid_t child = fork();
  if (child == 0) {
    sandbox.enter();
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

TEST_F(Sandboxed, NetworkSocketsAreRefusedAndLocalOnesAreNot) {
  if (!has_seccomp()) GTEST_SKIP() << "no seccomp";
  for (const int family : {AF_INET, AF_INET6, AF_PACKET, AF_NETLINK}) {
    EXPECT_EQ(in_sandbox({}, [&] { return error_of(socket(family, SOCK_DGRAM, 0)); }), EPERM);
  }
  EXPECT_EQ(in_sandbox({}, [] { return error_of(socket(AF_UNIX, SOCK_STREAM, 0)); }), 0);
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
