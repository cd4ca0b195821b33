/// Sweeps that end early by signals.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <thread>

#include "harness/sweep/process/sanitized.hpp"
#include "harness/sweep/store/sqlite.hpp"
#include "tests/support/command.hpp"
#include "tests/support/store_text.hpp"

namespace loopbench::kill_test {

namespace {

#ifdef LOOPBENCH_SANITIZED
constexpr int kKills = 15;  // each start costs ten times as much
#else
constexpr int kKills = 40;
#endif

const char* const kConfig =
    "datasets: [{dataset: simulated, path: room, keyframes: 40, label: a},\n"
    "           {dataset: simulated, path: office, keyframes: 40, closures: {max: 0}, label: b}]\n"
    "methods: [raw, uniform, cubic_spline, uniform + cubic_spline]\nmetrics: [ate, axis_error]\n"
    "repeats: 6\n";

class Ended : public testing::Test {
 protected:
  CommandResult run(const std::string& arguments) { return loopbench_command(arguments, folder_); }

  /// `loopbench run c.yaml --out OUT` in the folder; the process, not a shell around it, and the
  /// leader of a process group.
  pid_t start(const std::string& out) {
    const std::string target = (folder_.path() / out).string();
    std::vector<std::string> words{
        LOOPBENCH_BINARY, "run", config_.string(), "--out", target, "--jobs", "3"};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 1, "/dev/null", O_WRONLY, 0);
    pid_t process = -1;
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawn(&process, LOOPBENCH_BINARY, &files, &attributes, arguments.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    return process;
  }

  /// Exit code, or 128 plus the signal.
  static int wait(pid_t process) {
    int status = 0;
    waitpid(process, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  std::filesystem::path store(const std::string& out) const {
    return folder_.path() / out / "results.sqlite";
  }

  TemporaryFolder folder_;
  const std::filesystem::path config_ = folder_.file("c.yaml", kConfig);
};

TEST_F(Ended, KilledAtAnyMomentItGoesOnToTheSameRows) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  ASSERT_EQ(wait(start("whole")), 0);
  const std::chrono::duration<double> takes = Clock::now() - begin;
  const std::string whole = store_text(store("whole"));
  std::mt19937_64 random(5);
  int kills = 0;
  int wholes = 0;
  for (int turn = 0; kills < kKills && turn < 50 * kKills; ++turn) {
    const pid_t process = start("k");
    const double share = static_cast<double>(random() % 1000) / 1000.0;
    std::this_thread::sleep_for(share * takes);
    ::kill(process, SIGKILL);
    const int code = wait(process);
    if (code == 128 + SIGKILL) {
      ++kills;
      continue;
    }
    ASSERT_EQ(code, 0) << "after " << kills << " kills";
    ASSERT_EQ(store_text(store("k")), whole) << "after " << kills << " kills";
    ++wholes;
    std::filesystem::remove_all(folder_.path() / "k");
  }
  EXPECT_EQ(kills, kKills);
  ASSERT_EQ(wait(start("k")), 0);
  EXPECT_EQ(store_text(store("k")), whole);
  RecordProperty("sweeps finished in between", wholes);
}

TEST_F(Ended, SignalsToTheProcessGroupFailNoCell) {
  ASSERT_EQ(wait(start("whole")), 0);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
    for (const int milliseconds : {20, 60, 120}) {
      const pid_t sweep = start("k");
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      ::kill(-sweep, signal);
      const int code = wait(sweep);
      EXPECT_TRUE(code == 0 || code == 130 || code == 128 + signal) << code;
    }
  }
  ASSERT_EQ(wait(start("k")), 0);
  EXPECT_EQ(store_text(store("k")), store_text(store("whole")));
}

TEST_F(Ended, AFreshSweepKeepsEveryCellOfAKilledOne) {
  ASSERT_EQ(run("run c.yaml --out k").exit_code, 0);
  // As a kill leaves it: the last transaction is only in the log.
  const std::filesystem::path file = store("k");
  const pid_t child = fork();
  if (child == 0) {
    Database database(file, Database::Mode::create);
    database.execute("PRAGMA journal_mode = WAL; PRAGMA wal_autocheckpoint = 0;");
    database.execute("UPDATE cell SET why = 'in the log'");
    raise(SIGKILL);
  }
  ASSERT_EQ(wait(child), 128 + SIGKILL);
  ASSERT_TRUE(std::filesystem::exists(file.string() + "-wal"));
  ASSERT_EQ(run("run c.yaml --out k --fresh").exit_code, 0);
  const std::filesystem::path previous = folder_.path() / "k/previous-1.sqlite";
  EXPECT_FALSE(std::filesystem::exists(previous.string() + "-wal")) << "one file holds all";
  Database kept(previous, Database::Mode::read);
  Statement count = kept.prepare("SELECT count(*) FROM cell WHERE why = 'in the log'");
  ASSERT_TRUE(count.step());
  EXPECT_EQ(count.integer(), 48);
}

}  // namespace
}  // namespace loopbench::kill_test
