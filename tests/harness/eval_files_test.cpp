// Input files of `eval`: stamps, files with positions only.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "datasets/core/se3.hpp"
#include "datasets/formats/formats.hpp"
#include "tests/support/eval_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::eval_files_test {
namespace {

using namespace test;
using testing::HasSubstr;

class EvalFiles : public testing::Test {
 protected:
  std::string written(const std::string& name, const std::string& text) const {
    return folder_.file(name, text).string();
  }
  /// Names of columns and the first row of the errors of poses.
  std::pair<std::string, std::string> first_error(const std::vector<std::string>& arguments) const {
    const std::filesystem::path file = folder_.path() / "poses.csv";
    eval(with(arguments, {"--align=none", "--per-pose=" + file.string()}));
    std::ifstream in(file);
    std::string header, row;
    std::getline(in, header);
    std::getline(in, row);
    return {header, row};
  }
  TemporaryFolder folder_;
};

// Several files are evaluated in parallel.
TEST_F(EvalFiles, ThreadsDoNotMatterForSeveralFiles) {
  const std::vector<std::string> estimates{
      golden("est_drift.txt"), golden("est_corrected.txt"), "absent.txt", golden("est_burst.txt")};
  std::vector<std::string> words{golden("gt.txt"), "--protocol=loopbench,tum"};
  const Json all = eval_json(with(words, estimates), kExitSomeCellsFailed);
  ASSERT_EQ(all.size(), 2 * estimates.size());
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    const Json alone =
        eval_json(with(words, {estimates[i]}), i == 2 ? kExitSomeCellsFailed : kExitOk);
    for (std::size_t k = 0; k < 2; ++k) {
      for (const char* key : {"estimate", "status", "why", "metrics", "pairs"}) {
        EXPECT_EQ(all[2 * i + k].value(key, Json()), alone[k].value(key, Json()))
            << estimates[i] << " " << key;
      }
    }
  }
}

TEST_F(EvalFiles, TellsWhatReadingMended) {
  const std::string reference = written(
      "reference.txt", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 1 1 0 0 0 0 1\n3 0 1 1 0 0 0 1\n");
  const std::string estimate = written("estimate.txt",
                                       "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1.005\n1 9 9 9 0 0 0 1\n"
                                       "2 1 1 0 0 0 0 1\n3 0 1 1 0 0 0 0.998\n");
  const Json results = eval_json({reference, estimate, "--repeats=keep_first"});
  EXPECT_NEAR(results["diagnosis"]["off_unit"].get<double>(), 0.005, 1e-12);
  EXPECT_EQ(results["diagnosis"]["left_out"], 1.0);
  EXPECT_NEAR(find(results, "ate", "translation")["rmse"].get<double>(), 0.0, 1e-12);
}

/// A curved path of 100 poses, tracked at the lever arm `aside`.
std::string bent_way(const std::filesystem::path& file, const Pose& aside) {
  Trajectory poses;
  Pose pose;
  for (int i = 0; i < 100; ++i) {
    poses.push_back({static_cast<double>(i), pose * aside});
    pose = normalized(
        pose * exp_se3(twist({1.0, 0.3 * (i % 5), 0.2}, {0.1 * (i % 2), 0.1 * (i % 3), 0.2})));
  }
  write_tum(file, poses);
  return file.string();
}

TEST_F(EvalFiles, SaysWhenTheReferenceIsAnotherBodyAndTakesItsPlace) {
  const std::string reference =
      bent_way(folder_.path() / "marker.txt", {Rotation(0.5, 0.5, 0.5, 0.5), {0.1, -0.2, 0.3}});
  const std::string estimate = bent_way(folder_.path() / "camera.txt", {});
  const std::string place = "0.1,-0.2,0.3,0.5,0.5,0.5,0.5";
  EXPECT_THAT(
      eval({reference, estimate}),
      HasSubstr("other body the reference seems to track another body, with the offset " + place));
  const Json plain = eval_json({reference, estimate});
  EXPECT_TRUE(plain.contains("other_body"));
  EXPECT_GT(find(plain, "ate", "translation")["rmse"].get<double>(), 0.1);

  const Json stated = eval_json({reference, estimate, "--ref-body=" + place});
  EXPECT_FALSE(stated.contains("other_body"));
  EXPECT_EQ(stated["reference_body"], place);
  EXPECT_NEAR(find(stated, "ate", "translation")["rmse"].get<double>(), 0.0, 1e-9);
  EXPECT_NEAR(find(stated, "rpe", "rotation")["rmse"].get<double>(), 0.0, 1e-6);
  EXPECT_THAT(eval({reference, estimate, "--ref-body=" + place}),
              HasSubstr("(100 poses), body offset " + place));
  for (const char* wrong :
       {"1,2", "1,2,3,", "1,2,x", "1,2,3,4", "1,2,3,0,0,0,1,1", "nan,0,0", ","}) {
    EXPECT_THAT(refusal<InputError>({reference, estimate, std::string("--ref-body=") + wrong}),
                HasSubstr("expected x,y,z [m] or x,y,z,qx,qy,qz,qw"))
        << wrong;
  }
  EXPECT_THAT(
      refusal<InputError>({reference, estimate, "--ref-body=0,0,0,0,0,0,2"}),
      HasSubstr("--ref-body: '0,0,0,0,0,0,2': expected a unit quaternion after the position"));
}

TEST_F(EvalFiles, NumberedPosesAreNotPairedWithStampedOnes) {
  const std::string numbered = golden("kitti_gt.txt"), stamped = golden("gt.txt");
  const std::string rule =
      ": is kitti, poses without stamps, and the other file has stamps: expected --times FILE "
      "(KITTI), --period S or --association index";
  EXPECT_EQ(refusal<InputError>({stamped, numbered}), numbered + rule);
  EXPECT_EQ(refusal<InputError>({numbered, stamped}), numbered + rule);
  const std::vector<std::string> options{
      "--period=0.1", "--offset=1700000000", "--max-diff=0.05", "--align=none"};
  EXPECT_GT(eval_json(with({stamped, numbered}, options))["pairs"], 100);
}

TEST_F(EvalFiles, ErrorsOfPosesHaveNoTurnWhereThereIsNoAttitude) {
  std::string positions, turning;
  for (int i = 0; i < 20; ++i) {
    const std::string place =
        std::to_string(i) + " " + std::to_string(i) + " " + std::to_string(i * i) + " 0 0 0 ";
    positions += place + "0 1\n";
    turning += place + (i % 2 == 0 ? "0 1\n" : "0.6 0.8\n");
  }
  const auto [header, row] =
      first_error({written("reference.txt", positions), written("estimate.txt", turning)});
  EXPECT_TRUE(header.ends_with(",distance_m,rx_rad,ry_rad,rz_rad,angle_rad")) << header;
  EXPECT_TRUE(row.ends_with(",0,0,0,0,0,,,,")) << row;  // stamp, x y z, distance
}

TEST_F(EvalFiles, AFailedEstimateKeepsTheBodyOfTheReference) {
  const std::string bad = written("bad.txt", "not a pose\n");
  const Json results = eval_json({golden("gt.txt"), bad, golden("gt.txt"), "--ref-body=0.1,0,0"},
                                 kExitSomeCellsFailed);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0]["status"], "failed");
  EXPECT_EQ(results[0]["reference_body"], "0.1,0,0");
  EXPECT_EQ(results[1]["reference_body"], "0.1,0,0");
}

TEST_F(EvalFiles, ErrorsOfPosesHaveTheStampsOfBoth) {
  const std::string rest = " 0 0 0 0 1\n";
  const auto [header, row] = first_error(
      {written("reference.txt", "1 0 0" + rest + "2 1 0" + rest + "3 1 1" + rest + "4 2 5" + rest),
       written("estimate.txt",
               "1.01 0 0" + rest + "2.01 1 0" + rest + "3.01 1 1" + rest + "4.01 2 5" + rest),
       "--association=evo",
       "--max-diff=0.1"});
  EXPECT_THAT(header, HasSubstr(",stamp,estimate_stamp,x_m,"));
  EXPECT_THAT(row, HasSubstr(",1,1.01,0,"));
}

// Pairs by the literal sync.py of evo: 6 of the 7 repeated stamps are within 0.01 s of a reference
// pose.
TEST_F(EvalFiles, KeepsEqualStampsAsEvoDoes) {
  std::ifstream drift(golden("est_drift.txt"));
  std::string repeated;
  std::size_t rows = 0;
  for (std::string line; std::getline(drift, line);) {
    repeated += line + "\n";
    if (line.starts_with('#') || rows++ % 100 != 0) continue;
    repeated += line.substr(0, line.find(' ')) + " 1 2 3 0 0 0 1\n";
  }
  const std::string file = written("repeated.txt", repeated);
  const Json result = eval_json({golden("gt.txt"), file, "--protocol=evo", "-a"});
  EXPECT_EQ(result["possible"], 664);
  EXPECT_EQ(result["pairs"], 641);
  const Json first = eval_json({golden("gt.txt"), file, "--protocol=evo", "--repeats=keep_first"});
  EXPECT_EQ(first["pairs"], 635);
  for (const char* protocols : {"--protocol=tum", "--protocol=loopbench"}) {
    EXPECT_THROW(eval({golden("gt.txt"), file, protocols}), InputError);
  }
  EXPECT_THAT(eval({golden("gt.txt"), file, "--protocol=evo,tum"}, kExitSomeCellsFailed),
              HasSubstr("is already on line"));
  // Either file can repeat stamps.
  EXPECT_EQ(eval_json({file, golden("gt.txt"), "--protocol=evo", "-a"})["pairs"], 641);
}

}  // namespace
}  // namespace loopbench::eval_files_test
