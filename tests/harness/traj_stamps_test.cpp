// Stamps that `traj` reads, shifts, assumes and merges.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "datasets/formats/trajectory_file.hpp"
#include "tests/support/command.hpp"
#include "tests/support/eval_command.hpp"

namespace loopbench::traj_stamps_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using namespace harness;

using test::traj;
using test::traj_refusal;

/// A folder with poses on the x axis.
class TrajStamps : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  /// A TUM file with a pose for each stamp and the position x = `x`.
  std::string tum(const std::string& name,
                  const std::vector<std::string>& stamps,
                  const std::string& x = "1") const {
    std::ofstream out(path(name));
    for (const std::string& stamp : stamps) out << stamp << " " << x << " 0 0 0 0 0 1\n";
    return path(name);
  }

  std::string kitti(const std::string& name, std::size_t poses) const {
    std::ofstream out(path(name));
    for (std::size_t i = 0; i < poses; ++i) out << "1 0 0 " << i << " 0 1 0 0 0 0 1 0\n";
    return path(name);
  }

  std::vector<std::int64_t> nanoseconds(const std::string& name) const {
    return read_trajectory_file(path(name)).nanoseconds;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(TrajStamps, ConvertAndAlignWriteStampsWithTheOffset) {
  const std::string est = tum("est.txt", {"1700000000.100000001", "1700000000.200000001"});
  const std::string ref = tum("ref.txt", {"1700000003.600000001", "1700000003.700000001"});
  traj({"convert", est, "--offset", "3.5", "-o", path("out.txt")});
  EXPECT_THAT(nanoseconds("out.txt"), ElementsAre(1700000003600000001, 1700000003700000001));
  EXPECT_EQ(nanoseconds("ref.txt"), nanoseconds("out.txt"));
  const std::string out = path("aligned.txt");
  traj({"align", est, "--ref", ref, "--t_offset", "3.5", "--align", "origin", "-o", out});
  EXPECT_THAT(nanoseconds("aligned.txt"), ElementsAre(1700000003600000001, 1700000003700000001));
}

TEST_F(TrajStamps, PosesWithoutStampsAreNotPairedWithStamps) {
  const std::string est = kitti("est.txt", 3);
  const std::string ref = tum("ref.txt", {"0", "0.1", "0.2"});
  const std::string why = est + ": is kitti, poses without stamps, and " + ref +
                          " has stamps: expected --period S, or a file with stamps (traj convert "
                          "FILE --times TIMES -o NEW)";
  EXPECT_EQ(traj_refusal({"align", est, "--ref", ref, "-o", path("a.txt")}), why);
  EXPECT_EQ(traj_refusal({"merge", ref, est, "-o", path("a.txt")}), why);
  const auto align = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"align", est, "--align", "none", "--json"});
    return test::Json::parse(traj(options).output).at(0);
  };
  EXPECT_EQ(align({"--ref", ref, "--period", "0.1"}).at("pairs"), 3);
  EXPECT_EQ(align({"--ref", kitti("other.txt", 3)}).at("pairs"), 3);
}

TEST_F(TrajStamps, AssumedStampsArePrinted) {
  const std::string est = kitti("est.txt", 3);
  EXPECT_THAT(traj({"info", est}).output,
              HasSubstr("remark          no stamps: assumed 0.1 s between poses (--period S)\n"));
  EXPECT_THAT(traj({"info", est, "--period", "0.1"}).output, Not(HasSubstr("no stamps")));
  EXPECT_EQ(traj({"convert", est, "-o", path("a.txt")}).errors,
            "loopbench: " + est + " has no stamps: assumed 0.1 s between poses (--period S)\n");
  EXPECT_THAT(traj({"convert", est, "--period", "1", "-o", path("a.txt")}).errors, IsEmpty());
  EXPECT_THAT(traj({"convert", est, "--to", "kitti", "-o", path("a.txt")}).errors, IsEmpty());
}

TEST_F(TrajStamps, APeriodNeedsPosesWithoutStamps) {
  const std::string ref = tum("ref.txt", {"0", "0.1"}), est = tum("est.txt", {"0", "0.1"});
  const std::string why =
      "--period 0.2: all files have stamps, expected KITTI poses without --times, or g2o";
  EXPECT_EQ(traj_refusal({"convert", est, "--period", "0.2", "-o", path("a.txt")}), why);
  EXPECT_FALSE(std::filesystem::exists(path("a.txt")));
  EXPECT_EQ(traj_refusal({"info", est, "--period", "0.2"}), why);
  EXPECT_EQ(traj_refusal({"align", est, "--ref", ref, "--period", "0.2"}), why);
  traj({"align", est, "--ref", kitti("k.txt", 2), "--period", "0.1", "--align", "none"});
}

TEST_F(TrajStamps, ADashIsStandardOutputBesideAFolderOfThatName) {
  const std::string est = tum("est.txt", {"0", "1"});
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::create_directory(path("-"));
  std::filesystem::current_path(path("."));
  EXPECT_EQ(traj({"convert", est, "-o", "-"}).output, "0 1 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  std::filesystem::current_path(before);
}

TEST_F(TrajStamps, WhatMergingAndScalingLoseIsSaid) {
  const std::string plain = tum("a.txt", {"0", "1"});
  std::string rows = "#%TANGENT_CONVENTION fixed_axes\n";
  for (const char* stamp : {"2000", "3000"}) {
    rows += std::string(stamp) + " 0 0 0 0 0 0 1";
    rows += " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1";
    rows += "\n";
  }
  std::ofstream(path("b.txt")) << rows;
  EXPECT_THAT(traj({"merge", plain, path("b.txt"), "-o", path("out.txt")}).errors,
              HasSubstr("merge: covariances are removed"));
  EXPECT_EQ(
      traj({"transform", path("b.txt"), "--stamp-scale", "0.001", "-o", path("out.txt")}).errors,
      "");
  const TrajectoryFile scaled = read_trajectory_file(path("out.txt"));
  EXPECT_EQ(scaled.covariances.size(), 2u);
  EXPECT_EQ(scaled.poses[1].stamp, 3.0);
  std::ofstream(path("points.txt")) << "0 1 2 3 0 0 0 0\n1 1 2 3 0 0 0 0\n";
  EXPECT_THAT(
      traj_refusal({"transform", path("points.txt"), "--invert-poses", "-o", path("x.txt")}),
      HasSubstr("--invert-poses needs rotations"));
}

TEST_F(TrajStamps, RepeatsAcrossMergedFilesFollowTheOption) {
  const std::string a = tum("a.txt", {"0", "1", "2"}, "1");
  const std::string b = tum("b.txt", {"1", "2", "3"}, "5");
  const auto merged_x = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"merge", a, b, "-o", path("out.txt")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const std::string errors = traj(arguments).errors;
    std::vector<double> out;
    for (const StampedPose& pose : read_trajectory(path("out.txt"))) {
      out.push_back(pose.world_from_body.translation.x());
    }
    return std::pair(out, errors);
  };
  const std::string why = ": dropped 2 poses with the stamp of a pose of another file\n";
  EXPECT_EQ(merged_x({}), std::pair(std::vector<double>({1, 1, 1, 5}), "loopbench: " + b + why));
  EXPECT_EQ(merged_x({"--repeats", "keep_first"}), merged_x({}));
  EXPECT_EQ(merged_x({"--repeats", "keep_last"}),
            std::pair(std::vector<double>({1, 5, 5, 5}), "loopbench: " + a + why));
  EXPECT_EQ(traj_refusal({"merge", a, b, "--repeats", "refuse", "-o", path("out.txt")}),
            "stamp 1.0 is in two files, expected --repeats keep_first or keep_last");
}

TEST_F(TrajStamps, TheExtensionOfTheOutputIsItsFormat) {
  const std::string est = tum("est.txt", {"0", "1"});
  for (const auto& [name, format] : {std::pair{"out.g2o", Format::g2o},
                                     std::pair{"out.csv", Format::csv},
                                     std::pair{"out.kitti", Format::kitti},
                                     std::pair{"out", Format::tum}}) {
    traj({"convert", est, "-o", path(name)});
    EXPECT_EQ(detect_format(path(name)), format) << name;
  }
  traj({"convert", est, "--to", "tum", "-o", path("out.csv")});
  EXPECT_EQ(detect_format(path("out.csv")), Format::tum);
  for (const char* const to : {"auto", "bag", "nonsense"}) {
    EXPECT_EQ(traj_refusal({"convert", est, "--to", to}),
              "to = " + std::string(to) + ": expected one of tum | kitti | euroc | g2o | csv");
  }
  for (const std::string name : {"x.dat", "x.bag"}) {
    EXPECT_EQ(traj_refusal({"convert", est, "-o", name}),
              name +
                  ": expected a file name that ends in .txt, .tum, .csv, .g2o or .kitti, or "
                  "--to FORMAT");
  }
}

}  // namespace
}  // namespace loopbench::traj_stamps_test
