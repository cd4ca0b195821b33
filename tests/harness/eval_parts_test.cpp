// Parts of an estimate with frames of their own, loops without a reference, rows as motions.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "datasets/core/se3.hpp"
#include "tests/support/eval_command.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::test::eval_parts_test {
namespace {

using testing::HasSubstr;

Pose on_path(double t) {
  return {exp_so3({0, 0, 0.3 * t}) * exp_so3({0.2 * std::sin(t), 0, 0}),
          {4.0 * std::cos(0.4 * t), 3.0 * std::sin(0.5 * t), std::sin(0.3 * t)}};
}

std::string row(double stamp, const Pose& pose) {
  const auto& [q, p] = pose;
  return fmt::format("{:.3f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n",
                     stamp,
                     p.x(),
                     p.y(),
                     p.z(),
                     q.x(),
                     q.y(),
                     q.z(),
                     q.w());
}

/// 400 rows at 10 Hz; from `restart` on in a new map that begins at the identity.
std::string run(int restart = 400) {
  std::string out;
  const Pose origin = on_path(0.1 * restart).inverse();
  for (int i = 0; i < 400; ++i) {
    const Pose pose = on_path(0.1 * i);
    out += row(0.1 * i, i < restart ? pose : origin * pose);
  }
  return out;
}

TEST(EvalParts, HaveAnAlignmentEach) {
  const TemporaryFolder scratch;
  const std::string truth = scratch.file("gt.txt", run());
  const std::string guess = scratch.file("est.txt", run(150));
  const Json all = eval_json({truth, guess, "--parts=auto"});
  ASSERT_EQ(all.size(), 3u);
  EXPECT_THAT(std::string(all[0]["estimate"]), HasSubstr("rows 0-149"));
  EXPECT_THAT(std::string(all[1]["estimate"]), HasSubstr("rows 150-399"));
  EXPECT_THAT(std::string(all[2]["estimate"]), HasSubstr("(2 parts)"));
  for (const Json& each : all) EXPECT_LT(find(each, "ate", "translation")["rmse"], 1e-6);
  EXPECT_EQ(all[2]["pairs"], 400);
  EXPECT_EQ(all[2]["possible"], 400);
  EXPECT_EQ(find(all[2], "ate", "translation")["count"], 400);
  EXPECT_GT(find(eval_json({truth, guess}), "ate", "translation")["rmse"], 0.5);
  EXPECT_THAT(eval({truth, guess, "--parts=auto"}), HasSubstr("(2 parts)"));
}

TEST(EvalParts, OfAFile) {
  const TemporaryFolder scratch;
  const std::string truth = scratch.file("gt.txt", run());
  const std::string guess = scratch.file("est.txt", run(150));
  const std::string parts = scratch.file("parts.txt", "# first last\n0 9.95\n15 39.95\n");
  const Json all = eval_json({truth, guess, "--parts=" + parts});
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0]["pairs"], 100);
  EXPECT_EQ(all[2]["pairs"], 350);
  EXPECT_EQ(all[2]["possible"], 400);
  const std::string begins = scratch.file("begins.txt", "0\n15\n");
  EXPECT_EQ(eval_json({truth, guess, "--parts=" + begins})[2]["pairs"], 400);
  const std::string wrong = scratch.file("wrong.txt", "0 1 2\n");
  EXPECT_THROW(eval({truth, guess, "--parts=" + wrong}), InputError);
}

TEST(EvalParts, OfAFileAreInOrderWithoutCommonPoses) {
  const TemporaryFolder scratch;
  const std::string truth = scratch.file("gt.txt", run());
  const auto why = [&](const std::string& text) {
    const std::string parts = scratch.file("parts.txt", text);
    return refusal_of<InputError>([&] { eval({truth, truth, "--parts=" + parts}); });
  };
  EXPECT_THAT(why("0 30\n20 39.95\n"), HasSubstr("parts.txt:2: the part begins with row 200"));
  EXPECT_THAT(why("0 20\n20 39.95\n"), HasSubstr("parts.txt:2: the part begins with row 200"));
  EXPECT_THAT(why("20\n0\n"), HasSubstr("parts.txt:2: the part begins at 0 s"));
  EXPECT_THAT(why("0 20\n50 60\n"), HasSubstr("parts.txt:2: part 2 has no poses"));
}

/// Along each axis, 0.01 m to either side.
std::string noisy_run() {
  std::string out;
  for (int i = 0; i < 400; ++i) {
    Pose pose = on_path(0.1 * i);
    for (int k = 0; k < 3; ++k) pose.translation[k] += 0.01 * std::sin(1e3 * i + 1e2 * k);
    out += row(0.1 * i, pose);
  }
  return out;
}

TEST(EvalParts, DegreesOfFreedomAreThoseOfTheProtocol) {
  const TemporaryFolder scratch;
  const std::string truth = scratch.file("gt.txt", run());
  const std::string guess = scratch.file("est.txt", noisy_run());
  const std::string parts = scratch.file("parts.txt", "0\n");  // all poses
  for (const char* const ddof : {"--set=ddof=0", "--set=ddof=1"}) {
    const Json all = eval_json({truth, guess, "--parts=" + parts, ddof});
    const double part = find(all[0], "ate", "translation")["std"];
    EXPECT_NEAR(find(all[1], "ate", "translation")["std"], part, 1e-6 * part) << ddof;
  }
}

TEST(EvalParts, WhyAPartFailedNamesNoOtherFiles) {
  const TemporaryFolder scratch;
  const std::string truth = scratch.file("gt.txt", run());
  const std::string parts = scratch.file("parts.txt", "0 0.05\n1 39.95\n");
  const std::string out = eval({truth, truth, "--parts=" + parts, "--full"}, kExitSomeCellsFailed);
  EXPECT_THAT(out, HasSubstr("coincide"));
  EXPECT_THAT(out, testing::Not(HasSubstr("reference reference")));
}

TEST(EvalParts, AreWrittenBySplit) {
  const TemporaryFolder scratch;
  const std::string truth = scratch.file("gt.txt", run());
  const std::string guess = scratch.file("est.txt", run(150));
  const std::string folder = scratch.path() / "parts/";
  in_process("traj", {"split", guess, "--ref=" + truth, "--out=" + folder});
  EXPECT_TRUE(std::filesystem::exists(folder + "est_part1.txt"));
  EXPECT_THAT(in_process("traj", {"info", folder + "est_part2.txt"}), HasSubstr("250"));
}

TEST(EvalParts, ALoopNeedsNoReferenceForTheErrorAtItsEnd) {
  const TemporaryFolder scratch;
  std::string loop;
  for (int i = 0; i <= 100; ++i) {  // a circle of 10 m, which ends 0.5 m above its start
    const double angle = 2.0 * M_PI * i / 100.0;
    loop +=
        row(0.1 * i,
            {exp_so3({0, 0, angle}), {10.0 * std::cos(angle), 10.0 * std::sin(angle), 0.005 * i}});
  }
  const std::string file = scratch.file("loop.txt", loop);
  const Json found = eval_json({file, "--end-error"});
  EXPECT_NEAR(found["translation_m"], 0.5, 1e-9);
  EXPECT_NEAR(found["rotation_deg"], 0.0, 1e-5);
  EXPECT_NEAR(found["share_percent"], 100.0 * 0.5 / 62.83, 0.001);
  EXPECT_THROW(eval({file}), InputError);
  for (const char* const ignored :
       {"--plot=a.pdf",     "--report=a.html", "--store=st",   "--csv",        "--per-pose=a.csv",
        "--start=1",        "--end=5",         "--parts=auto", "--metric=ate", "--align=sim3",
        "--align_origin",   "--protocol=evo",  "--set=ddof=1", "--delta=5",    "--full",
        "--ref-body=0,0,1", "--ref-positions", "--cov=a.txt",  "--offset=1",   "--min-coverage=0.5",
        "--unit=mm"}) {
    const std::string option = std::string(ignored).substr(0, std::string(ignored).find('='));
    EXPECT_THAT(refusal_of<InputError>([&] {
                  eval({file, "--end-error", ignored});
                }),
                HasSubstr("expected no " + option));
  }
}

TEST(EvalParts, RowsThatAreMotionsAreChained) {
  const TemporaryFolder scratch;
  const std::string truth = scratch.file("gt.txt", run());
  std::string motions = row(0.0, Pose{});
  for (int i = 1; i < 400; ++i) {
    motions += row(0.1 * i, on_path(0.1 * (i - 1)).inverse() * on_path(0.1 * i));
  }
  const std::string file = scratch.file("motions.txt", motions);
  const std::string out = scratch.path() / "chained.txt";
  in_process("traj", {"transform", file, "--chain", "--out=" + out});
  EXPECT_LT(find(eval_json({truth, out}), "ate", "translation")["rmse"], 1e-4);
}

}  // namespace
}  // namespace loopbench::test::eval_parts_test
