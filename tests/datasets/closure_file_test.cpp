#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/derive/closures.hpp"
#include "datasets/derive/odometry.hpp"
#include "tests/datasets/random_poses.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::closure_file_test {
namespace {

using testing::HasSubstr;

constexpr ClosureNoise kNoise = {0.5, 0.25};

std::string refusal(const std::string& content) {
  const TemporaryFolder folder;
  const auto file = folder.file("closures.txt", content);
  return refusal_of([&] { read_closure_file(file, kNoise); });
}

TEST(ClosureFile, IsReadByColumns) {
  const TemporaryFolder folder;
  const auto file = folder.file("closures.txt",
                                "# from to pose\n\n"
                                "1.5 9.25 1 2 3 0 0 0.6 0.8\n"
                                "2 8 0 0 0 0 0 0 1 0.1 0.2\n");
  const auto closures = read_closure_file(file, kNoise);
  ASSERT_EQ(closures.size(), 2u);
  EXPECT_EQ(closures[0].stamp_from, 1.5);
  EXPECT_EQ(closures[0].stamp_to, 9.25);
  EXPECT_EQ(closures[0].from_from_to.translation, Vector3(1.0, 2.0, 3.0));
  EXPECT_NEAR(closures[0].from_from_to.rotation.z(), 0.6, 1e-15);
  EXPECT_NEAR(closures[0].from_from_to.rotation.w(), 0.8, 1e-15);
  EXPECT_EQ(closures[0].noise.sigma_t, 0.5);
  EXPECT_EQ(closures[0].line, 3u);
  EXPECT_EQ(closures[1].noise.sigma_t, 0.1);
  EXPECT_EQ(closures[1].noise.sigma_r, 0.2);
}

TEST(ClosureFile, RefusalsNameFileAndLine) {
  EXPECT_THAT(refusal("# one\n1 2 3\n"), HasSubstr("closures.txt:2: "));
  EXPECT_THAT(refusal("1 2 3\n"), HasSubstr("9 or 11"));
  EXPECT_THAT(refusal("1 2 0 0 0 0 0 0 1 0.1\n"), HasSubstr("10 columns"));
  EXPECT_THAT(refusal("1 2 0 0 zero 0 0 0 1\n"), HasSubstr("(translation): 'zero'"));
  EXPECT_THAT(refusal("1 2 0 0 nan 0 0 0 1\n"), HasSubstr("closures.txt:1: "));
  EXPECT_THAT(refusal("1 2 0 0 0 0 0 0 2\n"), HasSubstr("closures.txt:1: "));
  EXPECT_THAT(refusal("1 2 0 0 0 0 0 0 1 0.1 0\n"), HasSubstr("sigma_r 0"));
  EXPECT_THAT(refusal_of([] { read_closure_file("absent.txt", kNoise); }), HasSubstr("absent.txt"));
}

TEST(ClosureFile, BecomesEdgesBetweenNearestPosesInOrder) {
  const Trajectory poses = on_a_line({0, 1, 2, 3, 4});
  const Pose pose{exp_so3({0.1, 0.2, 0.3}), {1.0, 2.0, 3.0}};
  const std::vector<StampedClosure> closures = {{1.01, 4.0, pose, kNoise, 1},
                                                {3.0, 0.0, pose, kNoise, 2}};
  const auto edges = as_edges(closures, poses, 0.02, "f");
  ASSERT_EQ(edges.size(), 2u);
  EXPECT_EQ(edges[0].from, 0u);
  EXPECT_EQ(edges[0].to, 3u);
  EXPECT_TRUE(is_close(edges[0].from_from_to, pose.inverse(), 1e-12, 1e-12));
  EXPECT_EQ(edges[1].from, 1u);
  EXPECT_EQ(edges[1].to, 4u);
  EXPECT_EQ(edges[1].information, isotropic_information(0.25, 0.0625));
}

TEST(ClosureFile, TurnedRoundKeepsWhatANoiseMeans) {
  // The same error has the same cost for the edge and its inverse.
  const Trajectory poses = on_a_line({0, 1});
  const Pose pose{exp_so3({0.1, 0.2, 0.3}), {1.0, 2.0, 3.0}};
  const auto edges = as_edges({{1.0, 0.0, pose, {0.1, 0.3}, 1}}, poses, 0.02, "f");
  const Twist error = twist({1e-6, 2e-6, -1e-6}, {3e-6, -1e-6, 2e-6});
  const Matrix6 information = isotropic_information(0.01, 0.09);
  const Twist turned = log_se3(edges[0].from_from_to.inverse() * (pose * exp_se3(error)).inverse());
  EXPECT_NEAR(
      turned.dot(edges[0].information * turned) / error.dot(information * error), 1.0, 1e-5);
}

TEST(ClosureFile, NamesTheStampThatNoPoseHas) {
  const Trajectory poses = on_a_line({0, 1, 2});
  EXPECT_THAT(refusal_of([&] {
                as_edges({{0.0, 1.5, {}, kNoise, 7}}, poses, 0.02, "loops.txt");
              }),
              HasSubstr("loops.txt:7: found stamp 1.5"));
  EXPECT_THAT(refusal_of([&] {
                as_edges({{1.0, 1.01, {}, kNoise, 8}}, poses, 0.02, "loops.txt");
              }),
              HasSubstr("loops.txt:8: "));
}

}  // namespace
}  // namespace loopbench::closure_file_test
