// A program that stays running answers forked processes. Its failures: programs_test.py.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/sweep/catalogue/server.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::serve_test {

using namespace harness;
using namespace methods;

namespace {

/// Asks from a forked process, as the cells of a worker do; returns whether the answer is right.
bool asks_in_a_child(const CommandOptions& options, const Problem& problem, bool dies = false) {
  const pid_t child = fork();
  if (child == 0) {
    Report report;
    if (dies) {
      alarm(1);  // the program hangs, and the cell is killed
    }
    try {
      const Trajectory out = ask_server(options, problem, report);
      _exit(out.size() == problem.keyframes.size() ? 0 : 1);
    } catch (const std::exception&) {
      _exit(2);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST(Server, AnswersForkedProcessesAndRecoversFromTheirEnd) {
  CommandOptions options;
  options.serve = LOOPBENCH_SERVING " hang";
  const Problem problem = test::circle(30);
  prepare_server(options);
  EXPECT_TRUE(asks_in_a_child(options, problem));
  prepare_server(options);
  EXPECT_FALSE(asks_in_a_child(options, problem, true)) << "the second request hangs";
  prepare_server(options);  // starts it again
  EXPECT_TRUE(asks_in_a_child(options, problem));
}

}  // namespace
}  // namespace loopbench::serve_test
