// `eval --store`: notes, options and the gate.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "harness/compare/gate.hpp"
#include "harness/compare/snapshot.hpp"
#include "harness/report/sections.hpp"
#include "harness/store/read.hpp"
#include "tests/support/eval_command.hpp"
#include "tests/support/recorded_files.hpp"

namespace loopbench::eval_store_options_test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using namespace harness;

class EvalStoreOptions : public test::RecordedFiles {};

TEST_F(EvalStoreOptions, PrintsFindingsOfTheDoctorOncePerKind) {
  std::vector<std::string> arguments{write("reference.txt", long_path(0.0))};
  for (int run = 0; run < 10; ++run) {  // stamps 0.35 s late
    Trajectory late = long_path(0.001 * run);
    for (StampedPose& pose : late) pose.stamp += 0.35;
    arguments.push_back(write("late/" + std::to_string(run) + ".txt", late));
  }
  testing::internal::CaptureStderr();
  stored(arguments);
  const std::string notes = testing::internal::GetCapturedStderr();
  EXPECT_THAT(notes, HasSubstr(path("late/0.txt") + ": doctor: time_offset: "));
  EXPECT_THAT(notes, HasSubstr("(and 9 more runs)"));
  EXPECT_LE(std::ranges::count(notes, '\n'), 5);
}

TEST_F(EvalStoreOptions, RejectsOptionsThatAStoreIgnores) {
  const auto error = [&](const std::string& option, const std::string& value) {
    return test::refusal<InputError>(
        test::with(files_of("office"), {"--store", path("store"), option, value}));
  };
  EXPECT_THAT(error("--plot", "out"), HasSubstr("loopbench plot " + path("store") + " -o FOLDER"));
  std::ofstream(path("times.txt")) << "0\n";
  EXPECT_THAT(error("--times", path("times.txt")), HasSubstr("no file has KITTI poses"));
  EXPECT_THAT(error("--period", "3"), HasSubstr("--period 3.0: all files have stamps"));
  EXPECT_FALSE(std::filesystem::exists(path("store")));
}

TEST_F(EvalStoreOptions, PrintsATableAndAVerdictForEachProtocol) {
  const std::string page = path("page.html");
  const std::string out = store_systems("store", {"--protocol", "evo,tum", "--report", page});
  EXPECT_TRUE(std::filesystem::exists(page));
  for (const char* const protocol : {"evo", "tum"}) {
    EXPECT_THAT(out, HasSubstr("\n### " + std::string(protocol) + "\n"));
    EXPECT_THAT(out, HasSubstr(", keyframes, " + std::string(protocol) + ": good is best: "));
  }
  const std::string without_ate = store_systems("ape", {"-r", "trans_part"});
  EXPECT_THAT(without_ate,
              HasSubstr("verdict: translation_part ape, rmse [m], keyframes, loopbench: "));
  EXPECT_THAT(without_ate, ContainsRegex("\\| ape[^|]* \\[m\\] +\\|\n"));
}

TEST_F(EvalStoreOptions, EvaluatesNoNumbersAgainstStamps) {
  std::ofstream kitti(path("kitti.txt"));
  for (int i = 0; i < 60; ++i) kitti << "1 0 0 " << i << " 0 1 0 0 0 0 1 0\n";
  kitti.close();
  EXPECT_THAT(stored({path("truths/office.txt"), path("kitti.txt")}, kExitSomeCellsFailed),
              HasSubstr("poses without stamps, and the other file has stamps"));
}

TEST_F(EvalStoreOptions, MetricsThatFailAreFailures) {
  const std::string out =
      stored(test::with(office({"good/office/0"}), {"--offset", "0.05"}), kExitSomeCellsFailed);
  EXPECT_THAT(out, HasSubstr("1 failed\nfailed: " + path("systems/good/office/0.txt")));
  EXPECT_THAT(out, HasSubstr("no pose of the estimate"));
}

TEST_F(EvalStoreOptions, LowCoverageHasExitCodeOne) {
  Trajectory part = path_of(0.01);
  part.resize(40);
  const std::vector<std::string> arguments{
      path("truths/office.txt"), write("part.txt", part), "--min-coverage", "0.9"};
  for (int call = 0; call < 2; ++call) {  // also if it is stored already
    EXPECT_THAT(stored(arguments, kExitSomeCellsFailed), HasSubstr("1 with coverage below 0.9"));
  }
}

TEST_F(EvalStoreOptions, TimesOfReadingFilesAreNotRecorded) {
  store_systems("store");
  for (const Record& r : all_records(path("store"))) EXPECT_NE(r.kind->metric, "time");
  EXPECT_THROW(compare_store(path("store"), "time", {}, CompareOptions{}), InputError);
  EXPECT_TRUE(costs(read_cells(path("store"))).lines.empty());
}

TEST_F(EvalStoreOptions, TablesShowAxesIfThereIsNoTotal) {
  const std::string out = test::eval(test::with(files_of("office"), {"-r", "rpy"}));
  EXPECT_THAT(out, ContainsRegex("\\| +ape roll \\[deg\\] +\\|\n"));  // of the runs
}

TEST_F(EvalStoreOptions, RejectsAFolderOfRuns) {
  const std::string reference = path("truths/office.txt"), folder = path("systems/good/office");
  EXPECT_EQ(test::refusal<InputError>({reference, folder}),
            folder + ": is a folder, expected trajectory files, for example `eval " + reference +
                " " + folder + "/*.txt`");
  EXPECT_THROW(test::eval({path("truths"), folder + "/0.txt"}), InputError);
}

TEST_F(EvalStoreOptions, TheGateComparesNewOutputsWithTheOldOnes) {
  const auto gate = [&](double change, const std::string& store) {
    for (const char* const sequence : {"office", "street"}) {
      for (int run = 0; run < 10; ++run) {
        write_run("new/good", sequence, run, (0.01 + 0.0005 * run) * change);
        write_run("new/bad", sequence, run, (0.03 + 0.0013 * run) * change);
      }
    }
    store_systems(store, {}, kExitOk, "new");
    Baseline baseline;
    baseline.limits = {Tolerance{}};
    baseline.limits.front().where = {"metric=ate"};
    baseline.snapshot = snapshot(path("old"), baseline.limits);
    return check(baseline, snapshot(path(store), baseline.limits));
  };
  store_systems("old");
  EXPECT_TRUE(gate(1.0, "equal").findings.empty());
  const GateReport better = gate(0.5, "better");
  EXPECT_TRUE(better.passes());
  EXPECT_GT(better.count(Finding::Kind::improvement), 0u);
  EXPECT_FALSE(gate(2.0, "worse").passes());
  // Another reference is another sequence.
  write_tum(path("truths/office.txt"), path_of(0.005));
  EXPECT_THROW(gate(1.0, "moved"), InputError);
}

}  // namespace
}  // namespace loopbench::eval_store_options_test
