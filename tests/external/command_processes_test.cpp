// What programs that run as methods start, allocate, read and write: ended, limited, restricted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>

#include "datasets/formats/formats.hpp"
#include "harness/base/sandbox.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/program_sweep.hpp"

namespace loopbench::command_processes_test {

using namespace harness;

namespace {

using testing::HasSubstr;

class CommandProcesses : public test::ProgramSweep {
 protected:
  /// Writes c.yaml with a recorded trajectory and these method entries.
  void write_recorded_sweep(const std::string& entries) {
    const Problem problem = test::circle(41);
    write_tum(folder_.path() / "estimate.txt", problem.keyframes);
    write_tum(folder_.path() / "reference.txt", problem.keyframes);
    folder_.file("c.yaml",
                 "datasets: [{dataset: trajectory, estimate: estimate.txt, reference: "
                 "reference.txt}]\ntimes: keyframes\nmetrics: [ate]\nmethods:\n" +
                     entries);
  }
  /// The same of `raw` on a dataset that is a program, with its cache in the folder of the test.
  void write_program_dataset(const std::string& options) {
    setenv("LOOPBENCH_CACHE", (folder_.path() / "cache").c_str(), 1);
    write_recorded_sweep("  - raw\n");
    const std::string config = read_all(folder_.path() / "c.yaml");
    folder_.file(
        "c.yaml",
        "datasets: [{dataset: command, " + options + "}]\n" + config.substr(config.find('\n') + 1));
  }
  ~CommandProcesses() override { unsetenv("LOOPBENCH_CACHE"); }
};

/// Whether a process has this command line, with blanks between its words.
bool is_running(const std::string& command_line) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::string text = read_all(entry.path() / "cmdline");
    for (char& c : text) c = c == '\0' ? ' ' : c;
    if (text == command_line + " ") return true;
  }
  return false;
}

bool ends_soon(const std::string& command_line) {
  for (int i = 0; i < 500 && is_running(command_line); ++i) usleep(10000);
  return !is_running(command_line);
}

TEST_F(CommandProcesses, ProcessesThatOutliveTheProgramAreKilled) {
  folder_.file("forks.sh",
               "sleep 8731 &\nsetsid sleep 8732 &\n(setsid sh -c 'sleep 8733 & sleep 8734' &)\n"
               "cp $1/keyframes.txt $2\n");
  for (const char* option : {"", " --no-sandbox"}) {
    const auto done = cells(
        entry("forks", "'sh forks.sh {problem} {result}'"), "", " --fresh" + std::string(option));
    ASSERT_EQ(done.size(), 2u);
    EXPECT_EQ(done[1].status, Status::ok) << done[1].why;
    for (const char* time : {"8731", "8732", "8733", "8734"}) {
      EXPECT_FALSE(is_running(std::string("sleep ") + time)) << time;
    }
  }
}

TEST_F(CommandProcesses, ProcessesOfAServerThatEndsAreKilled) {
  const auto done =
      cells("  - {method: command, serve: '" LOOPBENCH_SERVING " forks'}\n", "repeats: 4\n");
  ASSERT_EQ(done.size(), 8u);
  EXPECT_TRUE(std::ranges::any_of(done, [](const CellRow& cell) {
    return cell.why.text().find("exited with code 3") != std::string::npos;
  }));
  EXPECT_FALSE(is_running("sleep 8761"));
}

TEST_F(CommandProcesses, AForkBombIsEnded) {
  folder_.file("bomb.sh", "while :; do sleep 8771 & done\n");
  const auto done = cells(entry("bomb", "'sh bomb.sh {problem} {result}'"));
  ASSERT_EQ(done.size(), 2u);
  EXPECT_EQ(done[1].status, Status::failed);
  EXPECT_THAT(done[1].why, HasSubstr("more than 64 processes"));
  EXPECT_TRUE(ends_soon("sleep 8771"));
}

TEST_F(CommandProcesses, AHangingProgramIsKilledWithItsTreeAndItsFiles) {
  folder_.file("hangs.sh", "setsid sleep 8741 &\necho >$TMPDIR/left\nsleep 8742\n");
  const auto done =
      cells(entry("hangs", "'sh hangs.sh {problem} {result}'"), "limits: {seconds: 5}\n");
  ASSERT_EQ(done.size(), 2u);
  EXPECT_EQ(done[1].status, Status::timeout) << done[1].why;
  EXPECT_TRUE(ends_soon("sleep 8741"));
  EXPECT_TRUE(ends_soon("sleep 8742"));
}

TEST_F(CommandProcesses, WritesInItsFolderOnlyAndCannotReadTheReference) {
  if (!has_bubblewrap()) GTEST_SKIP() << "no bubblewrap";
  folder_.file("curious.sh",
               "cat reference.txt >/dev/null && echo has read the reference\n"
               "echo x >outside && echo has written beside the config\n"
               "echo x >$TMPDIR/inside && cp $1/keyframes.txt $2\n");
  write_recorded_sweep(entry("curious", "'sh curious.sh {problem} {result}'") +
                       "  - {method: command, label: served, serve: '" LOOPBENCH_SERVING
                       " curious'}\n");
  for (const char* option : {"", " --no-sandbox"}) {
    loopbench_command("run c.yaml --fresh --out r" + std::string(option), folder_);
    const auto done = read_cells(folder_.path() / "r");
    ASSERT_EQ(done.size(), 2u);
    const bool is_free = *option != '\0';
    for (const CellRow& cell : done) {
      EXPECT_EQ(cell.status, Status::ok) << cell.why;
      const std::string said = notes(cell);
      EXPECT_EQ(said.find("has read the reference") != std::string::npos, is_free) << said;
      EXPECT_EQ(said.find("has written beside the config") != std::string::npos, is_free) << said;
    }
  }
}

TEST_F(CommandProcesses, ProgramsOfSeveralFilesRunBesideTheirDataAndResults) {
  folder_.file("helper.py",
               "import shutil\n\ndef correct(folder, result):\n"
               "    shutil.copy(folder + '/keyframes.txt', result)\n");
  folder_.file("mine.py", "import sys\nfrom helper import correct\ncorrect(*sys.argv[1:])\n");
  folder_.file("lists.sh", "ls >/dev/null && cp $1/keyframes.txt $2\n");  // as Octave
  folder_.file("fails.sh", "exit 3\n");
  write_recorded_sweep(entry("mine", "'python3 mine.py {problem} {result}'") +
                       entry("lists", "'sh lists.sh {problem} {result}'") +
                       entry("fails", "'sh fails.sh {problem} {result}'"));
  for (const char* option : {"", " --retry all"}) {
    loopbench_command("run c.yaml --data . --out r" + std::string(option), folder_);
    const auto done = read_cells(folder_.path() / "r");
    ASSERT_EQ(done.size(), 3u);
    for (const std::size_t i : {0u, 1u}) EXPECT_EQ(done[i].status, Status::ok) << done[i].why;
    EXPECT_THAT(done[2].why, HasSubstr("exited with code 3"));
    if (has_bubblewrap()) EXPECT_THAT(done[2].why, HasSubstr("the sandbox hides "));
  }
}

TEST_F(CommandProcesses, NoneOfItsProcessesAndFilesOutlivesAKilledSweep) {
  folder_.file("hangs.sh", "echo >$TMPDIR/left\nsetsid sleep 8751 &\nsleep 8752\n");
  const std::string served = "  - {method: command, serve: 'sh -c \"sleep 8753 & sleep 8754\"'}\n";
  using Sleeps = std::array<const char*, 2>;
  for (const auto& [method, all] : {std::pair{entry("hangs", "'sh hangs.sh {problem} {result}'"),
                                              Sleeps{"sleep 8751", "sleep 8752"}},
                                    std::pair{served, Sleeps{"sleep 8753", "sleep 8754"}}}) {
    folder_.file("c.yaml",
                 "datasets: [{dataset: simulated, path: room, keyframes: 40}]\nmethods:\n" +
                     method + "metrics: [ate]\n");
    const pid_t sweep = fork();
    if (sweep == 0) {
      if (chdir(folder_.path().c_str()) != 0) _exit(1);
      execl(LOOPBENCH_BINARY, "loopbench", "run", "c.yaml", "--out", "r", nullptr);
      _exit(1);
    }
    for (const char* each : all) {
      for (int i = 0; i < 1000 && !is_running(each); ++i) usleep(10000);
      EXPECT_TRUE(is_running(each)) << each;
    }
    kill(sweep, SIGKILL);
    waitpid(sweep, nullptr, 0);
    for (const char* each : all) EXPECT_TRUE(ends_soon(each)) << each;
    for (int i = 0; i < 500 && !std::filesystem::is_empty(tmp_); ++i) usleep(10000);
  }
}

TEST_F(CommandProcesses, CpuTimeAndMemoryAreThoseOfTheProgram) {
  folder_.file("burn.py",
               "import sys, time\n"
               "block = bytearray(60 << 20)\n"
               "while time.process_time() < 0.2: pass\n"
               "open(sys.argv[2], 'w').write(open(sys.argv[1] + '/keyframes.txt').read())\n");
  const auto done = cells(entry("burns", "'python3 burn.py {problem} {result}'"));
  ASSERT_EQ(done.size(), 2u) << ran_.err;
  EXPECT_GE(done[1].cpu_seconds.value_or(0.0), 0.15) << done[1].why;  // sampled in a sandbox
  EXPECT_GE(done[1].peak_memory.value_or(0), 60 << 20);
  EXPECT_FALSE(done[1].added_memory) << "there is no earlier size of a new process";
}

TEST_F(CommandProcesses, ADatasetCannotReadTheReferenceOrWriteElsewhere) {
  if (!has_bubblewrap()) GTEST_SKIP() << "no bubblewrap";
  write_program_dataset(
      "sequence: estimate.txt, reference: reference.txt, run: 'sh curious.sh {sequence} "
      "{trajectory}'");
  const std::string script =
      "cat reference.txt && exit 9\necho x >outside && exit 8\n"
      "echo x >$TMPDIR/inside && cp $1 $2\n";
  folder_.file("curious.sh", script);
  EXPECT_EQ(successful_command("run c.yaml --out r", folder_).exit_code, 0);
  folder_.file("curious.sh", script + "\n");
  EXPECT_EQ(loopbench_command("run c.yaml --no-sandbox --out r", folder_).exit_code, 1);
  EXPECT_THAT(read_cells(folder_.path() / "r").at(0).why.text(), HasSubstr("exited with code 9"));
}

/// A dataset that copies the reference if it can, otherwise the estimate without its first pose.
TEST_F(CommandProcesses, NoOutputOfAnUnrestrictedDatasetIsUsedByASweep) {
  if (!has_bubblewrap()) GTEST_SKIP() << "no bubblewrap";
  const auto write = [&](const std::string& options) {
    write_program_dataset("sequence: estimate.txt, " + options +
                          "run: 'sh copies.sh {sequence} {trajectory}'");
  };
  folder_.file("copies.sh",
               "touch outside 2>/dev/null\ncp reference.txt $2 2>/dev/null || sed 1d $1 >$2\n");
  const auto poses = [&] {
    successful_command("run c.yaml --out r", folder_);
    return read_records(folder_.path() / "r").at(0).statistics.count;
  };
  write("reference: reference.txt, ");
  successful_command("run c.yaml --dry-run", folder_);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "outside"));
  EXPECT_EQ(poses(), 40u);
  successful_command("run c.yaml --no-sandbox --out r", folder_);
  EXPECT_EQ(read_records(folder_.path() / "r").at(0).statistics.count, 41u);
  EXPECT_EQ(poses(), 40u) << "a cell of an unrestricted program is not kept, either";
  std::filesystem::remove_all(folder_.path() / "cache");
  write("");  // the program may read what is no reference
  successful_command("run c.yaml --out other", folder_);
  write("reference: reference.txt, ");
  EXPECT_EQ(poses(), 40u);
}

TEST_F(CommandProcesses, AProgramEndsWithTheDryRunThatWaitsForIt) {
  write_program_dataset(
      "seconds: 1, reference: reference.txt, run: \"sh -c 'trap : TERM; sleep 8781; : $0' "
      "{trajectory}\"");
  for (const char* option : {"", " --no-sandbox"}) {
    const CommandResult ran =
        loopbench_command("run c.yaml --dry-run" + std::string(option), folder_);
    EXPECT_EQ(ran.exit_code, 2);
    EXPECT_THAT(ran.err, HasSubstr("took longer than 1 s"));
    EXPECT_TRUE(ends_soon("sleep 8781")) << option;
  }
}

TEST_F(CommandProcesses, FilesInMemoryCountAsMemory) {
  if (!has_bubblewrap()) GTEST_SKIP() << "no bubblewrap";
  const std::string before = getenv("TMPDIR");
  const std::string in_memory = "/dev/shm/loopbench-test-" + std::to_string(getpid());
  for (const std::string file : {"/dev/shm/x", "$TMPDIR/x"}) {
    if (file.front() == '$') {
      std::filesystem::create_directory(in_memory);
      setenv("TMPDIR", in_memory.c_str(), 1);
    }
    folder_.file("fills.sh",
                 "head -c 400M /dev/zero >" + file + " && sleep 1 && cp $1/keyframes.txt $2\n");
    const auto done = cells(entry("fills", "'sh fills.sh {problem} {result}'"),
                            "limits: {memory: 256MiB}\n",
                            " --fresh");
    ASSERT_EQ(done.size(), 2u);
    EXPECT_EQ(done[1].status, Status::out_of_memory) << file << ": " << done[1].why;
  }
  setenv("TMPDIR", before.c_str(), 1);
  EXPECT_TRUE(std::filesystem::remove(in_memory)) << "it is not empty";
}

TEST_F(CommandProcesses, MemoryOfTheTreeIsLimited) {
  const auto done = cells(entry("grows", R"("sh -c 'tail /dev/zero' {problem} {result}")"),
                          "limits: {memory: 700MiB}\n");
  ASSERT_EQ(done.size(), 2u);
  EXPECT_EQ(done[1].status, Status::out_of_memory) << done[1].why;
  EXPECT_THAT(done[1].why, HasSubstr("grew "));
}

}  // namespace
}  // namespace loopbench::command_processes_test
