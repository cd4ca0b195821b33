/// A zoo of misbehaving methods: each costs its own cell, for the right reason, and no other cell.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <map>
#include <numbers>
#include <string_view>
#include <thread>

#include "harness/sweep/process/sanitized.hpp"
#include "harness/sweep/store/read.hpp"
#include "tests/support/command.hpp"

namespace loopbench::zoo_test {

using namespace harness;

namespace {

struct Fate {
  const char* method;
  const char* status;  ///< "A or B" if the order of checks decides
  const char* why;     ///< part of the reason
};

#ifdef LOOPBENCH_SANITIZED  // ends the process itself
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif
const char* const kSegfault = kSanitized ? "" : "SIGSEGV";
const char* const kExit = kSanitized ? "exit code" : "exit code 3";

const Fate kFates[] = {
    // end their process
    {"segfault", "crashed", kSegfault},
    {"abort_now", "crashed", "SIGABRT"},
    {"abort_in_thread", "crashed", "SIGABRT"},
    {"abort_later", "ok", ""},
    {"exit_3", "crashed", kExit},
    {"exit_quietly", "crashed", "exit code 0"},
    {"kill_itself", "crashed", "SIGKILL"},
    {"overflow_stack", "crashed", kSegfault},
    {"long_jump", "ok", ""},
    {"unmap_itself", "crashed", kSegfault},
    {"unload_itself", "ok", ""},
    // never return
    {"spin", "timeout", "time limit"},
    {"sleep_in_shell", "timeout", "time limit"},
    {"close_all_and_wait", "timeout", "time limit"},
    {"block_signals_and_wait", "timeout", "time limit"},
    {"stop_itself", "timeout", "time limit"},
    {"linger", "timeout", "time limit"},
    {"nap", "ok", ""},
    // start or signal other processes
    {"leave_child", "ok", ""},
    {"leave_grandchildren", "ok", ""},
    {"fork_bomb", "failed or out_of_memory", "the cell "},
    {"kill_parent", "crashed", "its worker process was ended by SIGKILL"},
    {"stop_parent", "timeout", "its worker process was stopped"},
    {"kill_group", "crashed", "SIGKILL"},
    // change the state of their process
    {"round_upward", "ok", ""},
    {"flush_denormals", "ok", ""},
    {"trap_division", "ok", ""},
    {"change_input", "ok", ""},
    {"change_directory", "ok", ""},
    {"change_umask", "ok", ""},
    {"change_environment", "ok", ""},
    {"change_locale", "ok", ""},
    {"ignore_signals", "ok", ""},
    {"set_alarm", "ok", ""},
    {"leave_threads", "ok", ""},
    {"close_all", "ok", ""},
    {"write_to_descriptors", "ok", ""},
    {"write_to_shared_memory", "ok", ""},
    // memory and output without end
    {"leak", "ok", ""},
    {"allocate_without_end", "out_of_memory", ""},
    {"allocate_in_child", "out_of_memory", "limit"},
    {"flood_output", "failed", "printed more than 16 MiB"},
    {"flood_errors", "failed", "printed more than 16 MiB"},
    // return or throw what they should not
    {"return_nan", "failed", ""},
    {"return_nothing", "failed", ""},
    {"return_nan_section", "failed", "section"},
    {"throw_number", "failed", "not a std::exception"},
    {"throw_long_text", "failed", "xxx"},
    {"throw_bad_alloc", "out_of_memory", ""},
};
bool fills_memory(const Fate& fate) { return fate.status == std::string_view("out_of_memory"); }
constexpr std::size_t kBetween = 8;  ///< beasts between two honest cells

/// Two laps of a circle, 1 s between poses; the estimate drifts upwards.
std::string laps(double drift) {
  std::string out;
  for (int i = 0; i < 40; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 20.0;
    out += std::to_string(i) + " " + std::to_string(3.0 * std::cos(angle)) + " " +
           std::to_string(3.0 * std::sin(angle)) + " " + std::to_string(drift * i) + " 0 0 " +
           std::to_string(std::sin(0.5 * angle)) + " " + std::to_string(std::cos(0.5 * angle)) +
           "\n";
  }
  return out;
}

const std::string kDataset =
    "datasets: [{dataset: trajectory, reference: truth.txt, estimate: estimate.txt,\n"
    "            closures: {source: reference}}]\nmetrics: [ate, axis_error]\n";
const std::string kHonest = "uniform + cubic_spline";

class Zoo : public testing::Test {
 protected:
  Zoo() {
    folder_.file("truth.txt", laps(0.0));
    folder_.file("estimate.txt", laps(0.01));
    std::string methods = "methods:\n", greedy = "methods:\n";
    std::size_t beasts = 0;
    for (const Fate& fate : kFates) {
      if (fills_memory(fate)) {
        greedy += std::string("  - {method: ") + fate.method + ", label: " + fate.method + "}\n";
        continue;
      }
      if (beasts++ % kBetween == 0) {
        methods += "  - {method: " + kHonest + ", label: honest" + std::to_string(beasts) + "}\n";
      }
      methods += std::string("  - {method: ") + fate.method + ", label: " + fate.method + "}\n";
    }
    const std::string memory = kSanitized ? "400MiB" : "100MiB";
    const std::string seconds = kSanitized ? "8" : "2.5";
    folder_.file(
        "zoo.yaml",
        kDataset + "limits: {seconds: " + seconds + ", memory: " + memory + "}\n" + methods);
    // On a busy machine, memory takes a while to fill.
    folder_.file("greedy.yaml",
                 kDataset + "limits: {seconds: 60, memory: " + memory + "}\n" + greedy);
    folder_.file("honest.yaml", kDataset + "methods: [" + kHonest + "]\n");
  }

  void run(const std::string& arguments) {
    const CommandResult result =
        loopbench_command("run " + arguments + " --plugin '" LOOPBENCH_ZOO "'", folder_);
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1) << result.err;
  }

  /// Scores of each cell of the honest method, exactly.
  std::map<std::string, std::vector<double>> honest_scores(const std::string& out) const {
    std::map<std::string, std::vector<double>> scores;
    for (const Record& record : read_records(folder_.path() / out)) {
      if (record.cell->method != kHonest && !record.cell->method.text().starts_with("honest"))
        continue;
      EXPECT_EQ(record.status, Status::ok) << record.cell->method << ": " << record.why;
      for (const double value : {record.statistics.rmse, record.statistics.max}) {
        scores[record.cell->method].push_back(value);
      }
    }
    return scores;
  }

  /// `loopbench run CONFIG --out OUT --jobs 1` in the background, as leader of a process group.
  pid_t start(const std::string& config, const std::string& out) const {
    const std::string line = "cd '" + folder_.path().string() +
                             "' && exec '" LOOPBENCH_BINARY "' run " + config + " --out " + out +
                             " --jobs 1 --plugin '" LOOPBENCH_ZOO "' >.out 2>.err </dev/null";
    const pid_t process = fork();
    if (process == 0) {
      setpgid(0, 0);
      execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
      _exit(99);
    }
    return process;
  }
  static void sleep_for(double seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  }
  /// Waits until the store has a number of cells.
  void wait_for_cells(const std::string& out, std::size_t count) const {
    const std::filesystem::path store = folder_.path() / out / "results.sqlite";
    for (int i = 0; i < 600; ++i, sleep_for(0.05)) {
      try {
        if (read_cells(store).size() >= count) return;
      } catch (const std::exception&) {  // not yet there
      }
    }
    FAIL() << "no " << count << " cells after 30 s";
  }
  static int exit_code(pid_t process) {
    int status = 0;
    waitpid(process, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  /// Processes named zoo_stray.
  static int strays() {
    int out = 0;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      if (read_all(entry.path() / "comm") == "zoo_stray\n") ++out;
    }
    return out;
  }

  TemporaryFolder folder_;
};

TEST_F(Zoo, EachBeastCostsItsOwnCellForTheRightReason) {
  run("honest.yaml --out honest");
  const std::vector<double> wanted = honest_scores("honest").at(kHonest);
  ASSERT_FALSE(wanted.empty());
  for (const char* jobs : {"1", "2"}) {
    run(std::string("zoo.yaml --fresh --out zoo --jobs ") + jobs);
    EXPECT_EQ(strays(), 0) << "processes that outlive their cells";
    std::map<std::string, CellRow> cells;
    for (const CellRow& cell : read_cells(folder_.path() / "zoo")) cells[cell.method] = cell;
    run(std::string("greedy.yaml --fresh --out greedy --jobs ") + jobs);
    EXPECT_EQ(strays(), 0) << "processes that outlive their cells";
    for (const CellRow& cell : read_cells(folder_.path() / "greedy")) cells[cell.method] = cell;
    for (const Fate& fate : kFates) {
      const CellRow& cell = cells[fate.method];
      EXPECT_FALSE(cell.key.empty()) << fate.method << " has no cell";
      EXPECT_NE(std::string(fate.status).find(to_text(cell.status)), std::string::npos)
          << to_text(cell.status) << " " << fate.method << ": " << cell.why.text().substr(0, 200);
      EXPECT_NE(cell.why.text().find(fate.why), std::string::npos)
          << fate.method << ": " << cell.why.text().substr(0, 200);
    }
    for (const auto& [label, scores] : honest_scores("zoo")) EXPECT_EQ(scores, wanted) << label;
    const auto greedy = std::ranges::count_if(kFates, fills_memory);
    const std::size_t others = std::size(kFates) - static_cast<std::size_t>(greedy);
    EXPECT_EQ(honest_scores("zoo").size(), (others + kBetween - 1) / kBetween);
  }
}

TEST_F(Zoo, ClocksPauseWhileTheSweepIsStopped) {
  folder_.file("naps.yaml",
               kDataset + "limits: {seconds: 5}\nmethods: [{method: nap, label: a}, " +
                   "{method: nap, label: b}]\n");
  const pid_t sweep = start("naps.yaml", "naps");
  wait_for_cells("naps", 1);
  kill(-sweep, SIGTSTP);  // as Ctrl-Z
  sleep_for(6.0);
  kill(-sweep, SIGCONT);
  EXPECT_EQ(exit_code(sweep), 0) << read_all(folder_.path() / ".out");
  for (const CellRow& cell : read_cells(folder_.path() / "naps")) {
    EXPECT_EQ(cell.status, Status::ok) << cell.why;
  }
}

TEST_F(Zoo, ASecondInterruptAbandonsRunningCellsWhichRunAgain) {
  folder_.file("c.yaml", kDataset + "methods: [" + kHonest + ", sleep_in_shell]\n");
  const pid_t sweep = start("c.yaml", "k");
  wait_for_cells("k", 1);
  kill(-sweep, SIGINT);
  sleep_for(0.5);
  EXPECT_EQ(waitpid(sweep, nullptr, WNOHANG), 0) << "the first waits for running cells";
  kill(-sweep, SIGINT);
  EXPECT_EQ(exit_code(sweep), 130);
  EXPECT_EQ(read_cells(folder_.path() / "k").size(), 1u) << "the other is run next time";
  const std::string errors = read_all(folder_.path() / ".err");
  EXPECT_NE(errors.find("1 running cells abandoned"), std::string::npos) << errors;
}

TEST_F(Zoo, NothingOutlivesAKilledSweep) {
  folder_.file("c.yaml", kDataset + "methods: [" + kHonest + ", linger]\n");
  const pid_t sweep = start("c.yaml", "k");
  wait_for_cells("k", 1);
  for (int i = 0; i < 100 && strays() == 0; ++i) sleep_for(0.05);
  EXPECT_GT(strays(), 0) << "the cell has started them";
  kill(sweep, SIGKILL);
  EXPECT_EQ(exit_code(sweep), 128 + SIGKILL);
  for (int i = 0; i < 100 && strays() > 0; ++i) sleep_for(0.05);
  EXPECT_EQ(strays(), 0);
}

}  // namespace
}  // namespace loopbench::zoo_test
