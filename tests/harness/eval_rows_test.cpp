// Rows keep their numbers in `eval`: dropped rows, parts of KITTI sequences, frames with times.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "tests/support/eval_command.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::test::eval_rows_test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Rows of KITTI along a curve; `lost` ones have no pose.
std::string kitti(int rows, double step, const std::set<int>& lost = {}) {
  std::string out;
  for (int i = 0; i < rows; ++i) {
    const double x = step * i;
    out += lost.contains(i) ? "0 0 0 0 0 0 0 0 0 0 0 0\n"
                            : "1 0 0 " + std::to_string(x) + " 0 1 0 " +
                                  std::to_string(0.01 * x * x) + " 0 0 1 0\n";
  }
  return out;
}

TEST(EvalRows, OfDroppedRowsThePartnersAreDroppedToo) {
  const TemporaryFolder scratch;
  const std::string truth = scratch.file("gt.kitti", kitti(30, 1.0, {3}));
  const std::string guess = scratch.file("est.kitti", kitti(30, 1.0, {10, 11}));
  const std::vector<std::string> arguments{
      truth, guess, "--association=index", "--align=none", "--drop-invalid"};
  const Json result = eval_json(arguments);
  EXPECT_NEAR(find(result, "ate", "translation")["rmse"], 0.0, 1e-9);
  EXPECT_EQ(result["pairs"], 27);
  EXPECT_EQ(result["possible"], 28);
  EXPECT_THAT(eval(arguments), HasSubstr("30 rows each and no stamps, 27 are paired"));
  // Files that differ in rows are not paired by chance.
  const std::string fewer = scratch.file("fewer.kitti", kitti(29, 1.0));
  EXPECT_THROW(eval({truth, fewer, "--association=index", "--drop-invalid"}), InputError);
}

TEST(EvalRows, ATimeRangeCutsBothFilesThatArePairedByRow) {
  const TemporaryFolder scratch;
  const std::string truth = scratch.file("gt.kitti", kitti(100, 5.0));
  const std::string guess = scratch.file("est.kitti", kitti(100, 5.0));
  const Json result = eval_json({truth, guess, "--protocol=kitti", "--start=2", "--end=8"});
  EXPECT_EQ(result["pairs"], 61);
  EXPECT_EQ(result["possible"], 61);
  EXPECT_NEAR(find(result, "ate", "translation")["rmse"], 0.0, 1e-9);
}

TEST(EvalRows, APathThatIsTooShortForSegmentsIsALine) {
  const TemporaryFolder scratch;
  const std::string truth = scratch.file("gt.kitti", kitti(30, 1.0));
  EXPECT_THAT(eval({truth, truth, "--protocol=kitti"}),
              HasSubstr("note       segments: the reference has a constant orientation"));
  std::string turning;
  for (int i = 0; i < 30; ++i) {
    const std::string c = std::to_string(std::cos(0.02 * i)),
                      s = std::to_string(std::sin(0.02 * i));
    turning += c + " 0 " + s + " " + std::to_string(i) + " 0 1 0 0 -" + s + " 0 " + c + " 0\n";
  }
  const std::string near = scratch.file("near.kitti", turning);
  EXPECT_THAT(eval({near, near, "--protocol=kitti"}),
              HasSubstr("note       segments: no segment of the reference (29.0 m) has a length of "
                        "100 m, 200 m, "));
  const std::string far = scratch.file("far.kitti", kitti(100, 5.0));
  EXPECT_THAT(eval({far, far, "--protocol=kitti"}), Not(HasSubstr("no segment")));
}

TEST(EvalRows, AFolderOfFramesIsOneEstimate) {
  const TemporaryFolder scratch;
  const std::string truth = scratch.file("gt.kitti", kitti(12, 1.0));
  const auto folder = scratch.path() / "pose";
  std::filesystem::create_directories(folder);
  const auto write = [&](int i, const std::string& text) {
    std::filesystem::rename(scratch.file("x", text), folder / (std::to_string(i) + ".txt"));
  };
  for (int i = 0; i < 12; ++i) {
    const std::string x = std::to_string(1.0 * i), z = std::to_string(0.01 * i * i);
    write(i, "1 0 0 " + x + "\n0 1 0 " + z + "\n0 0 1 0\n0 0 0 1\n");
  }
  const Json result = eval_json({truth, folder.string(), "--align=none"});
  EXPECT_EQ(result["pairs"], 12);
  EXPECT_NEAR(find(result, "ate", "translation")["rmse"], 0.0, 1e-9);
  for (int i = 0; i < 12; ++i) write(i, "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n");  // runs
  EXPECT_THAT(refusal_of<InputError>([&] {
                eval({truth, folder.string()});
              }),
              HasSubstr("is a folder, expected trajectory files"));
}

TEST(EvalRows, NumbersOfFramesTakeTheTimesOfTheirRows) {
  const TemporaryFolder scratch;
  std::string truth, guess, times = "# timestamp filename\n";
  for (int i = 0; i < 40; ++i) {
    const std::string pose =
        " " + std::to_string(i) + " " + std::to_string(0.01 * i * i) + " 0 0 0 0 1\n";
    const std::string stamp = std::to_string(100.0 + 0.1 * i);
    truth += stamp + pose;
    if (i % 5 == 0) guess += std::to_string(i) + ".0" + pose;
    times += stamp + " rgb/" + std::to_string(i) + ".png\n";
  }
  const Json result = eval_json({scratch.file("gt.txt", truth).string(),
                                 scratch.file("est.txt", guess).string(),
                                 "--times=" + scratch.file("rgb.txt", times).string(),
                                 "--align=none"});
  EXPECT_EQ(result["pairs"], 8);
  EXPECT_NEAR(find(result, "ate", "translation")["rmse"], 0.0, 1e-9);
}

}  // namespace
}  // namespace loopbench::test::eval_rows_test
