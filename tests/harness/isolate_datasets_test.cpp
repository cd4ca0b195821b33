/// Datasets of plugins that change their process: nothing of it reaches cells.
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include <cfenv>
#include <clocale>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <thread>

#include "harness/sweep/run/check_output.hpp"
#include "harness/sweep/run/pack.hpp"
#include "harness/sweep/text/printable.hpp"
#include "tests/support/isolated_fixture.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::tiny::isolate_datasets_test {
namespace {

class IsolatedDatasets : public IsolatedFixture {};

/// Calls `work` with every socket of this process above the standard streams.
void for_sockets(const std::function<void(int)>& work) {
  for (int descriptor = 3; descriptor < 4096; ++descriptor) {
    int kind = 0;
    socklen_t size = sizeof kind;
    if (getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &kind, &size) == 0) work(descriptor);
  }
}

TEST_F(IsolatedDatasets, ADatasetHasNoConnectionToTheSweep) {
  known_.datasets.push_back(line_after("writes", [] {
    const std::string stray(4096, 'x');
    for_sockets([&](int socket) { send(socket, stray.data(), stray.size(), MSG_NOSIGNAL); });
    for_sockets([](int socket) { close(socket); });
  }));
  expect_ok("datasets: [writes, line]\nmethods: [straight, shift]\nmetrics: [ate]\n", 2, 4);
}

TEST_F(IsolatedDatasets, OutputOfADatasetOfAPluginIsLimited) {
  known_.datasets.push_back(line_after("prints", [] {
    const std::string block(1 << 20, 'x');
    for (int i = 0; i < 64; ++i) {
      if (write(STDOUT_FILENO, block.data(), block.size()) < 0) return;
    }
  }));
  known_.versions["dataset prints"] = "1";
  testing::internal::CaptureStderr();
  const std::vector<CellResult> results =
      run("datasets: [prints, line]\nmethods: [straight]\nmetrics: [ate]\n", 1);
  EXPECT_LT(testing::internal::GetCapturedStderr().size(), 100'000u);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].status, Status::failed);
  EXPECT_EQ(results[0].why, "loading its sequence printed more than 16 MiB");
  EXPECT_EQ(results[1].status, Status::ok);
}

TEST_F(IsolatedDatasets, NothingOfADatasetRunsInItsCells) {
  known_.datasets.push_back(line_after("leaves", [] {
    std::thread([] {
      for (;;) pause();
    }).detach();
    pthread_atfork(nullptr, nullptr, [] { _exit(9); });
    itimerval soon{{0, 0}, {0, 1000}};
    setitimer(ITIMER_REAL, &soon, nullptr);
    std::signal(SIGALRM, SIG_IGN);
  }));
  expect_ok("datasets: [leaves, line]\nmethods: [straight, shift]\nmetrics: [ate]\n", 1, 4);
}

/// Reports the state of its process.
struct ReportsState final : Corrector {
  using Options = NoOptions;
  explicit ReportsState(const Options&) {}
  Trajectory correct(const Problem& problem, Report& report) const override {
    sigset_t blocked;
    sigprocmask(SIG_SETMASK, nullptr, &blocked);
    report.count("rounding", std::fegetround());
    report.count("file mode mask", umask(0));
    report.count("blocked", sigismember(&blocked, SIGUSR1));
    report.count("ignored", std::signal(SIGUSR2, SIG_DFL) == SIG_IGN ? 1 : 0);
    report.count("variable", std::getenv("LOOPBENCH_TEST_STATE") != nullptr ? 1 : 0);
    report.notes = {std::filesystem::current_path().string(), std::setlocale(LC_ALL, nullptr)};
    return problem.keyframes;
  }
};

TEST_F(IsolatedDatasets, ADatasetDoesNotChangeTheStateOfLaterCells) {
  known_.methods.push_back(method<ReportsState>("reports_state", ""));
  known_.datasets.push_back(line_after("meddles", [] {
    std::fesetround(FE_UPWARD);
    umask(0123);
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_SETMASK, &all, nullptr);
    std::signal(SIGUSR2, SIG_IGN);
    setenv("LOOPBENCH_TEST_STATE", "1", 1);
    std::filesystem::current_path("/");
    std::setlocale(LC_ALL, "C.UTF-8");
  }));
  const auto states = [&](const std::string& datasets) {
    std::vector<std::string> out;
    const std::string config =
        "datasets: [" + datasets + "]\nmethods: [reports_state]\nmetrics: [ate]\n";
    for (const CellResult& result : run(config, 1)) {
      EXPECT_EQ(result.status, Status::ok) << result.why;
      Packer pack;
      pack(result.report.counts)(result.report.notes)(result.scores);
      out.push_back(pack.bytes());
    }
    return out;
  };
  const std::vector<std::string> alone = states("line");
  ASSERT_EQ(alone.size(), 1u);
  EXPECT_EQ(states("meddles, line"), (std::vector{alone[0], alone[0]}));
}

TEST_F(IsolatedDatasets, LongTextsOfDatasetsAreCut) {
  known_.datasets.push_back(
      dataset<LineOptions>("talks", "", [](const LineOptions& options, const DataRoot& root) {
        Sequence out = load_line(options, root);
        out.provenance.notes.assign(2 * kMostItems, std::string(100'000, 'n'));
        return out;
      }));
  testing::internal::CaptureStderr();
  const std::vector<CellResult> results =
      run("datasets: [{dataset: talks, bias: 0.5}]\nmethods: [straight]\nmetrics: [ate]\n", 1);
  EXPECT_LT(testing::internal::GetCapturedStderr().size(), 3'000'000u);
  ASSERT_EQ(results.size(), 1u);
  ASSERT_TRUE(results[0].metadata);
  ASSERT_EQ(results[0].metadata->notes.size(), kMostItems + 1);
  EXPECT_TRUE(results[0].metadata->notes[0].detail.ends_with("nn ... (98000 more bytes)"));
}

TEST_F(IsolatedDatasets, MessagesOfDatasetsAreCutAndNotEmpty) {
  const auto message = [&](const std::string& name, const std::string& text) {
    known_.datasets.push_back(line_after(name, [=] { throw std::runtime_error(text); }));
    return refusal_of<InputError>(
        [&] { run("datasets: [" + name + "]\nmethods: [straight]\nmetrics: [ate]\n", 1); });
  };
  std::string much;
  much.resize(20'000'000, 'z');
  EXPECT_TRUE(message("long", much).ends_with("z ... (19990000 more bytes) (c.yaml:1)"));
  EXPECT_EQ(message("empty", ""), "empty: loading threw an exception without a message (c.yaml:1)");
  EXPECT_EQ(message("usual", "why"), "why (c.yaml:1)");
}

TEST(Printable, ControlCharactersOfAStreamDoNotReachTheTerminal) {
  std::string text = "a\x1b[2J\tb\r\n\x7f\xc3\xa9\xc2\x9b";
  char previous = '\0';
  make_printable(text, previous);
  EXPECT_EQ(text, "a?[2J\tb\r\n?\xc3\xa9\xc2?");
  EXPECT_EQ(previous, '\x9b');
}

}  // namespace
}  // namespace loopbench::tiny::isolate_datasets_test
