#include "datasets/columns/covariance_columns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/core/covariance.hpp"
#include "datasets/formats/trajectory_file.hpp"
#include "tests/datasets/scratch.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::covariance_columns_test {
namespace {

using testing::HasSubstr;

/// Symmetric positive definite, each entry different.
Matrix6 example() {
  Matrix6 root = Matrix6::Identity();
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < i; ++j) root(i, j) = 0.01 * (6 * i + j);
  }
  return root * root.transpose();
}

std::string row_of(const std::string& pose, const Matrix6& m, CovarianceColumns::Part part) {
  std::string out = pose;
  for (int i = 0; i < 6; ++i) {
    const int begin = part == CovarianceColumns::Part::upper ? i : 0;
    const int end = part == CovarianceColumns::Part::lower ? i + 1 : 6;
    for (int j = begin; j < end; ++j) out += " " + to_text(m(i, j));
  }
  return out + "\n";
}

TrajectoryFile read_text(const std::string& text, Repeats repeats = Repeats::refuse) {
  const TemporaryFolder scratch;
  return read_trajectory_file(scratch.file("wide.txt", text),
                              {.repeats = repeats, .positions = true});
}

const std::string kPose = "1 2 0 0 0 0 0 1";        // at (2, 0, 0)
const std::string kTurned = "1 2 0 0 0 0 0.6 0.8";  // x of the body is (0.28, 0.96, 0)
const std::string kFixed = "#%TANGENT_CONVENTION fixed_axes\n";

TEST(CovarianceColumns, BothTrianglesAndAllRowsAreTheSameMatrix) {
  using Part = CovarianceColumns::Part;
  for (const Part part : {Part::upper, Part::lower, Part::all}) {
    const TrajectoryFile file = read_text(kFixed + row_of(kTurned, example(), part));
    ASSERT_EQ(file.covariances.size(), 1u);
    EXPECT_EQ(file.covariances[0], example());
    EXPECT_EQ(file.format, Format::tum);
  }
}

TEST(CovarianceColumns, ARightPerturbationIsInTheAxesOfTheBody) {
  Matrix6 body = Matrix6::Identity();
  body(0, 0) = 4.0;
  const Vector3 x(0.28, 0.96, 0.0);
  const Matrix3 expected = Matrix3::Identity() + 3.0 * x * x.transpose();
  for (const char* header : {"", "#%TANGENT_CONVENTION right_perturbation\n"}) {
    const auto text = header + row_of(kTurned, body, CovarianceColumns::Part::upper);
    const Matrix6 read = read_text(text).covariances.at(0);
    EXPECT_TRUE((read.topLeftCorner<3, 3>().isApprox(expected, 1e-12)));
    EXPECT_TRUE((read.bottomRightCorner<3, 3>().isApprox(Matrix3::Identity(), 1e-12)));
  }
  // 36 columns without a header are as in messages of ROS.
  EXPECT_EQ(read_text(row_of(kTurned, body, CovarianceColumns::Part::all)).covariances.at(0), body);
}

TEST(CovarianceColumns, ALeftPerturbationTurnsAboutTheOriginOfTheWorld) {
  // d = rho + phi x (2, 0, 0), so that y receives twice the rotation about z, and z about -y.
  const std::string header = "#%TANGENT_CONVENTION left_perturbation\n";
  const Matrix6 read =
      read_text(header + row_of(kPose, Matrix6::Identity(), CovarianceColumns::Part::all))
          .covariances.at(0);
  EXPECT_EQ(read(0, 0), 1.0);
  EXPECT_EQ(read(1, 1), 5.0);
  EXPECT_EQ(read(1, 5), 2.0);
  EXPECT_EQ(read(2, 4), -2.0);
}

TEST(CovarianceColumns, TheRotationCanBeFirst) {
  Matrix6 given = Matrix6::Identity();
  given(0, 0) = 9.0;                // rotation about x
  given(0, 4) = given(4, 0) = 0.5;  // with y
  const Matrix6 read = read_text(kFixed + "#%TANGENT_ORDER rotation_translation\n" +
                                 row_of(kPose, given, CovarianceColumns::Part::all))
                           .covariances.at(0);
  EXPECT_EQ(read(3, 3), 9.0);
  EXPECT_EQ(read(1, 3), 0.5);
}

TEST(CovarianceColumns, RejectsWhatItCannotRead) {
  const auto why = [](const std::string& text) { return refusal_of([&] { read_text(text); }); };
  using Part = CovarianceColumns::Part;
  const std::string good = row_of(kPose, example(), Part::all);
  EXPECT_THAT(
      why("#\n#%TANGENT_CONVENTION middle\n" + good),
      HasSubstr("wide.txt:2: #%TANGENT_CONVENTION is 'middle', expected right_perturbation, "
                "left_perturbation or fixed_axes"));
  EXPECT_THAT(why("#%TANGENT_ORDER rx\n" + good), HasSubstr(":1: #%TANGENT_ORDER is 'rx'"));
  EXPECT_THAT(why("#%ROTATION_PARAM rpy\n" + good), HasSubstr("expected axis_angle"));
  Matrix6 wrong = example();
  wrong(2, 2) = -1.0;
  const std::string second = "2 2 0 0 0 0 0 1";
  EXPECT_THAT(why(good + row_of(second, wrong, Part::all)),
              HasSubstr("wide.txt:2: covariance is not positive definite"));
  Matrix6 planar = Matrix6::Zero();
  planar(0, 0) = planar(1, 1) = planar(5, 5) = 0.1;
  EXPECT_EQ(why(row_of(kPose, Matrix6::Zero(), Part::all) + row_of(second, planar, Part::all)), "");
  planar(0, 2) = planar(2, 0) = 0.1;
  EXPECT_THAT(why(row_of(kPose, planar, Part::all)), HasSubstr("is not positive definite"));
  wrong = example();
  wrong(0, 5) += 0.1;
  EXPECT_THAT(why(row_of(kPose, wrong, Part::all)), HasSubstr(":1: covariance is not symmetric"));
  EXPECT_THAT(why(good + second + "\n"),
              HasSubstr(":2: has 8 columns, expected 44 as in the first"));
  EXPECT_THAT(why(second + "\n" + good), HasSubstr(":2: has 44 columns, expected 8"));
  EXPECT_THAT(why(good + row_of(second, example(), Part::upper)), HasSubstr("has 29 columns"));
  // Diagonals of the upper triangle are at 0, 6, 11, 15, 18, 20, of the lower at 0, 2, 5, 9,
  // 14, 20.
  const std::string both = kPose + " 1 0 .3 0 0 .3 .3 0 0 .15 0 .15 0 0 .3 .3 0 0 .3 0 1\n";
  EXPECT_THAT(why(both), HasSubstr(":1: the upper and the lower triangle of a covariance fit"));
  EXPECT_EQ(why("#%FORMAT SQUARE/0.3\n" + both), "");
}

TEST(CovarianceColumns, FollowThePosesThatAreKept) {
  using Part = CovarianceColumns::Part;
  const std::string text =
      kFixed + row_of(kPose, Matrix6::Identity(), Part::all) + row_of(kPose, example(), Part::all);
  EXPECT_EQ(read_text(text, Repeats::keep_first).covariances.at(0), Matrix6::Identity());
  EXPECT_EQ(read_text(text, Repeats::keep_last).covariances.at(0), example());
}

TEST(CovarianceColumns, WritingAndReadingKeepsEveryBit) {
  const TemporaryFolder scratch;
  TrajectoryFile file;
  for (int i = 0; i < 3; ++i) {
    file.poses.push_back({1.0 + i, {Rotation(0.6, 0.0, 0.8, 0.0), {0.1 * i, 2.0, -1.0}}});
    file.covariances.push_back((1.0 + i) * example() / 3.0);
  }
  for (const auto& [name, format] :
       {std::pair{"a.txt", Format::tum}, std::pair{"a.csv", Format::csv}}) {
    EXPECT_TRUE(has_covariances(file, format));
    write_trajectory(scratch.path() / name, file, format);
    const TrajectoryFile read = read_trajectory_file(scratch.path() / name);
    EXPECT_TRUE(same_bits(read.poses, file.poses)) << name;
    EXPECT_EQ(read.covariances, file.covariances) << name;
  }
  EXPECT_FALSE(has_covariances(file, Format::kitti));
}

TEST(CovarianceColumns, CanBeInAFileOfTheirOwn) {
  const TemporaryFolder scratch;
  const auto file = scratch.path() / "cov.csv";
  const Trajectory poses{{1.0, Pose{}}, {2.0, Pose{}}};
  bool assumed = false;
  const auto read = [&](const std::string& text) {
    std::ofstream(file) << text;
    return read_covariance_file(file, poses, assumed);
  };
  const std::string rows = "1.0000001,4,0,0,0,5,0,0,0,6\n2.0,7,0,0,0,8,0,0,0,9\n";
  const std::vector<Matrix6> positions = read(rows);
  EXPECT_EQ(positions.at(1).diagonal(), (Twist() << 7, 8, 9, 0, 0, 0).finished());
  EXPECT_FALSE(assumed);
  EXPECT_EQ(read("1 4 0 0 5 0 6\n2 7 0 0 8 0 9\n"), positions);  // upper triangle
  EXPECT_EQ(read("1 4 0 5 0 0 6\n2 7 0 8 0 0 9\n"), positions);  // lower triangle
  using Part = CovarianceColumns::Part;
  const std::string both =
      row_of("1", example(), Part::lower) + row_of("2", example(), Part::lower);
  EXPECT_EQ(read(both).at(1), example());
  EXPECT_TRUE(assumed);
  const auto why = [&](const std::string& text) { return refusal_of([&] { read(text); }); };
  EXPECT_THAT(why("1 4 0 0 5 0 6\n"), HasSubstr("has covariances of 1 poses, expected 2"));
  EXPECT_THAT(why("1 4 0 0 5 0 6\n2.1 7 0 0 8 0 9\n"),
              HasSubstr(":2: stamp 2.1: expected 2.0, that of pose 1"));
  EXPECT_THAT(why("1 4 0 0\n"), HasSubstr("expected a stamp and 6, 9 (position), 21 or 36"));
}

TEST(CovarianceColumns, OfPositionsAreInTables) {
  const TemporaryFolder scratch;
  TrajectoryFile file{.poses = {{1.0, {no_rotation(), {1, 2, 3}}}}};
  Matrix6 position = Matrix6::Zero();
  position.topLeftCorner<3, 3>() = example().topLeftCorner<3, 3>();
  file.covariances = {position};
  EXPECT_FALSE(has_covariances(file, Format::tum));
  write_trajectory(scratch.path() / "a.csv", file, Format::csv);
  EXPECT_THAT(read_all(scratch.path() / "a.csv"), HasSubstr("z,cov_x_x,cov_x_y,cov_x_z,cov_y_y"));
  const TrajectoryFile read = read_trajectory_file(scratch.path() / "a.csv", {.positions = true});
  EXPECT_EQ(read.covariances, file.covariances);
  std::ofstream(scratch.path() / "b.csv") << "t,x,y,z,cov_x_x\n1,1,2,3,0.1\n";
  EXPECT_THAT(refusal_of([&] { read_trajectory(scratch.path() / "b.csv", {.positions = true}); }),
              HasSubstr("has a header of a covariance without cov_x_y"));
}

}  // namespace
}  // namespace loopbench::covariance_columns_test
