// `eval --store`: notes, options, layouts and the gate.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "harness/eval/note_summary.hpp"
#include "tests/support/eval_command.hpp"
#include "tests/support/recorded_files.hpp"

namespace loopbench::eval_store_options_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using namespace harness;

class EvalStoreOptions : public test::RecordedFiles {};

TEST_F(EvalStoreOptions, PrintsFindingsOfTheDoctorOncePerKind) {
  for (int run = 0; run < 10; ++run) {  // stamps 0.35 s late
    Trajectory late = long_path(0.001 * run);
    for (StampedPose& pose : late) pose.stamp += 0.35;
    std::filesystem::create_directories(path("late"));
    write_tum(path("late/" + std::to_string(run) + ".txt"), late);
  }
  write_tum(path("reference.txt"), long_path(0.0));
  std::vector<std::string> arguments{path("reference.txt")};
  for (int run = 0; run < 10; ++run) {
    arguments.push_back(path("late/" + std::to_string(run) + ".txt"));
  }
  arguments.insert(arguments.end(), {"--store", path("store")});
  testing::internal::CaptureStderr();
  test::eval(arguments);
  const std::string notes = testing::internal::GetCapturedStderr();
  EXPECT_THAT(notes, HasSubstr(path("late/0.txt") + ": doctor: time_offset: "));
  EXPECT_THAT(notes, HasSubstr("(and 9 more runs)"));
  EXPECT_LE(std::ranges::count(notes, '\n'), 5);
}

TEST(NoteSummary, HasOneLineOfEachKindAndAtMostFive) {
  NoteSummary notes;
  notes.add("a", {"few pairs: 4", "doctor: scale: 2; fix", "few pairs: 5"});
  notes.add("b", {"doctor: scale: 3; fix", "doctor: time_offset: 1; fix"});
  EXPECT_THAT(notes.lines(),
              ElementsAre("a: doctor: scale: 2; fix (and 1 more run)",
                          "b: doctor: time_offset: 1; fix",
                          "a: few pairs: 4"));
  notes.add("c", {"k1: x", "k2: x", "k3: x"});  // six kinds: four, and a line on the other two
  ASSERT_EQ(notes.lines().size(), 5u);
  EXPECT_THAT(notes.lines().back(), HasSubstr("2 other kinds"));
}

}  // namespace
}  // namespace loopbench::eval_store_options_test
