/// Groups of workers, on systems that permit them; and what the texts of the system mean.
#include "harness/execution/sandbox/control_group.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <iterator>

#include "harness/execution/isolate/process_tree.hpp"
#include "harness/execution/isolate/subreaper.hpp"
#include "tests/support/isolated_fixture.hpp"

namespace loopbench::control_group_test {

using namespace harness;

namespace {

std::filesystem::path own_group() {
  const auto text = [](const char* file) {
    std::ifstream in(file);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  return control_group_path(text("/proc/self/cgroup"), text("/proc/self/mountinfo"));
}

TEST(ControlGroupPath, IsBelowTheMountPoint) {
  const std::string mount =
      "24 1 0:21 / /proc rw - proc proc rw\n"
      "30 24 0:26 / /sys/fs/cgroup rw,nosuid shared:9 - cgroup2 cgroup2 rw,nsdelegate\n";
  EXPECT_EQ(control_group_path("0::/user.slice/a b.scope\n", mount),
            "/sys/fs/cgroup/user.slice/a b.scope");
  EXPECT_EQ(control_group_path("5:pids:/x\n0::/\n", mount), "/sys/fs/cgroup/");
}

TEST(ControlGroupPath, LeavesOutTheRootOfAMountOfAPart) {
  const std::string mount = "30 24 0:26 /docker/1 /sys/fs/cgroup ro - cgroup2 cgroup rw\n";
  EXPECT_EQ(control_group_path("0::/docker/1/a\n", mount), "/sys/fs/cgroup/a");
  EXPECT_EQ(control_group_path("0::/docker/12\n", mount), "");
}

TEST(ControlGroupPath, IsEmptyWhereTheGroupIsNotVisible) {
  EXPECT_EQ(control_group_path("5:pids:/x\n", "30 24 0:26 / /c rw - cgroup2 cgroup2 rw\n"), "");
  EXPECT_EQ(control_group_path("0::/../x\n", "30 24 0:26 / /c rw - cgroup2 cgroup2 rw\n"), "");
  EXPECT_EQ(control_group_path("0::/x\n", "30 24 0:26 / /c rw - cgroup cgroup rw,pids\n"), "");
}

TEST(ControlGroup, DoesNothingWithoutAFolder) {
  const ControlGroups off(false);
  EXPECT_EQ(off.summary(), "off");
  const ControlGroup group = off.group_of_worker();
  group.enter();
  group.limit_growth(1);
  EXPECT_EQ(group.ended_by_limit(), 0);
}

class RealControlGroup : public testing::Test {
 protected:
  void SetUp() override {
    if (ControlGroups(true).summary() == "off") GTEST_SKIP() << "no permission for control groups";
  }
  /// Wait status of a process in `group` that runs `work`.
  static int status_in(const ControlGroup& group, int (*work)()) {
    const pid_t child = fork();
    if (child == 0) {
      group.enter();
      _exit(work());
    }
    int status = 0;
    waitpid(child, &status, 0);
    return status;
  }
};

TEST_F(RealControlGroup, EndsWhatLeftItsParentAndItsProcessGroup) {
  const ControlGroups groups(true);
  const Subreaper reaper;
  {
    const ControlGroup group = groups.group_of_worker();
    EXPECT_EQ(status_in(group,
                        [] {
                          if (fork() > 0) return 0;
                          setsid();
                          for (;;) pause();
                        }),
              0);
    ASSERT_EQ(own_children().size(), 1u);
  }
  int status = 0;
  for (int i = 0; i < 5000 && waitpid(-1, &status, WNOHANG) == 0; ++i) usleep(1000);
  EXPECT_TRUE(WIFSIGNALED(status)) << "still running";
}

TEST_F(RealControlGroup, LeavesNoFolder) {
  std::filesystem::path folder;
  {
    const ControlGroups groups(true);
    const ControlGroup group = groups.group_of_worker();
    folder = groups.folder();
    EXPECT_TRUE(std::filesystem::exists(folder));
    EXPECT_EQ(status_in(group, [] { return 0; }), 0);
  }
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST_F(RealControlGroup, RemovesTheGroupsOfKilledSweepsOnly) {
  const std::filesystem::path killed = own_group() / "loopbench-killed";
  ASSERT_TRUE(std::filesystem::create_directories(killed / "worker-1"));
  const ControlGroups other(true);
  const ControlGroup group = other.group_of_worker();
  const ControlGroups groups(true);
  EXPECT_FALSE(std::filesystem::exists(killed));
  EXPECT_EQ(status_in(group, [] { return 0; }), 0) << "of a sweep that is running";
}

TEST_F(RealControlGroup, LimitsMemoryThatNoProcessMaps) {
  const ControlGroups groups(true);
  if (!groups.limits_memory()) GTEST_SKIP() << "no control group limits memory";
  const ControlGroup group = groups.group_of_worker();
  group.limit_growth(std::int64_t{32} << 20);
  const int status = status_in(group, [] {
    const int file = memfd_create("memory", 0);
    const std::string bytes(std::size_t{1} << 20, 'x');
    for (int i = 0; i < 100; ++i) {
      if (write(file, bytes.data(), bytes.size()) < 0) return 1;
    }
    return 0;
  });
  EXPECT_TRUE(WIFSIGNALED(status)) << WEXITSTATUS(status);
  EXPECT_EQ(group.ended_by_limit(), 1);
  group.remove_limit();
  EXPECT_EQ(status_in(group, [] { return 0; }), 0);
}

using SweepInGroups = isolated::IsolatedFixture;

TEST_F(SweepInGroups, NoticesMemoryThatNoProcessMaps) {
  const ControlGroups groups(true);
  if (!groups.limits_memory()) GTEST_SKIP() << "no control group limits memory";
  sandbox_.groups = &groups;
  const std::vector<CellResult> results =
      run("datasets: [line]\nlimits: {memory: 50MiB}\n"
          "methods: [{method: mis, deed: unmapped}, {method: mis, deed: nothing, label: b},\n"
          "          {method: mis, deed: flood, label: c}, {method: mis, deed: daemon, label: d}]\n"
          "metrics: [ate]\n",
          1);
  ASSERT_EQ(results.size(), 4u);
  EXPECT_EQ(results[0].status, Status::out_of_memory) << results[0].why;
  EXPECT_EQ(results[1].status, Status::ok) << results[1].why;
  EXPECT_EQ(results[2].status, Status::out_of_memory) << results[2].why;
  EXPECT_EQ(results[3].status, Status::ok) << results[3].why;
}

TEST_F(SweepInGroups, GivesTheSameResultsAsWithoutGroups) {
  const ControlGroups groups(true);
  const std::string text =
      "datasets: [line]\nmethods: [straight, {method: mis, deed: abort}]\nmetrics: [ate]\n";
  const std::vector<CellResult> without = run(text, 2);
  sandbox_.groups = &groups;
  const std::vector<CellResult> with = run(text, 2);
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i) {
    EXPECT_EQ(with[i].status, without[i].status);
    EXPECT_EQ(with[i].why, without[i].why);
  }
}

}  // namespace
}  // namespace loopbench::control_group_test
