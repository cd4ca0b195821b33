/// Work in a process of its own: what it returns, throws, and how it can fail.
#include "harness/sweep/process/own_process.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>
#include <vector>

#include "datasets/core/error.hpp"
#include "datasets/core/params.hpp"
#include "harness/sweep/process/sanitized.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::own_process_test {

using namespace harness;

namespace {

std::string failure_of(const std::function<void()>& deed, const ProcessLimits& limits = {}) {
  const auto work = [&] {
    deed();
    return std::string("returned");
  };
  return refusal_of<ProcessFailure>([&] { in_own_process(work, limits); });
}

TEST(OwnProcess, ReturnsAnyBytesAndChangesNothingHere) {
  std::string kept = "here";
  const std::string bytes = std::string(3'000'000, '\0') + "end";
  EXPECT_EQ(in_own_process([&] {
              kept = "there";
              return bytes;
            }),
            bytes);
  EXPECT_EQ(kept, "here");
}

TEST(OwnProcess, ReturnsAMillionPosesWithEdges) {
  const std::size_t size = 600'000'000;
  EXPECT_EQ(in_own_process([&] { return std::string(size, 'x'); }).size(), size);
}

TEST(OwnProcess, ExceptionsKeepTheirTypeAndMessage) {
  EXPECT_THROW(in_own_process([]() -> std::string { throw InputError("file:3: why"); }),
               InputError);
  try {
    in_own_process([]() -> std::string {
      throw OptionError("shere", "shere: unknown", {"shere", {"share"}, " (has: share)"});
    });
    FAIL() << "did not throw";
  } catch (const OptionError& error) {
    EXPECT_EQ(error.option(), "shere");
    EXPECT_STREQ(error.what(), "shere: unknown (has: share)");
    EXPECT_EQ(error.unknown().known, std::vector<std::string>{"share"});
  }
  EXPECT_THROW(in_own_process([]() -> std::string { throw 3; }), std::runtime_error);
}

TEST(OwnProcess, ItsEndIsAFailureWithItsReason) {
  EXPECT_EQ(failure_of([] { _exit(0); }), "exited with code 0");
  EXPECT_EQ(failure_of([] { raise(SIGKILL); }), "was ended by SIGKILL");
  const auto hangs = [] {
    if (fork() == 0) pause();  // ends with it
    for (;;) pause();
  };
  EXPECT_EQ(failure_of(hangs, {.seconds = 0.2}), "took longer than 0.2 s");
#ifndef LOOPBENCH_SANITIZED  // reserves more than any limit
  const auto grows = [] {
    std::vector<std::string> all;
    for (int i = 0; i < 100; ++i) all.emplace_back(std::size_t{10} << 20, 'x');
  };
  EXPECT_EQ(failure_of(grows, {.memory = std::int64_t{100} << 20}),
            "needs more memory than the limit of 104857600 bytes");
#endif
}

}  // namespace
}  // namespace loopbench::own_process_test
