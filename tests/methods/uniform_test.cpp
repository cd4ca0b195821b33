#include "methods/correctors/uniform.hpp"

#include <gtest/gtest.h>

#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::test::uniform_test {
namespace {

struct Result {
  Trajectory poses;
  Report report;

  Vector3 position(std::size_t i) const { return poses[i].world_from_body.translation; }
  double yaw(std::size_t i) const { return log_so3(poses[i].world_from_body.rotation).z(); }
  double count(const std::string& name) const { return test::count(report, name); }
};

Result corrected(const Problem& problem, const Params& params = {}) {
  Result out;
  const Uniform method(with(Uniform::Options{}, params));
  EXPECT_EQ(method.why_declined(problem), "");
  out.poses = method.correct(problem, out.report);
  return out;
}

Params option(const std::string& name, const std::string& word) { return {{name, word}}; }

Edge closure(std::size_t from, std::size_t to, const Vector3& position, double yaw = 0.0) {
  return {from, to, turned_about_z(yaw, position)};
}

void expect_position(const Vector3& result, const Vector3& expected) {
  EXPECT_NEAR((result - expected).norm(), 0.0, 1e-12)
      << result.transpose() << " is not " << expected.transpose();
}

TEST(Uniform, DistributesAPositionErrorByIndexAndMovesTheTail) {
  Problem problem = along_x({0, 1, 2, 3, 4, 6});
  problem.closures = {closure(0, 4, {4.0, 0.8, 0.0})};
  const Result result = corrected(problem);
  for (std::size_t i = 0; i < 5; ++i) {
    expect_position(result.position(i), static_cast<double>(i) * Vector3(1.0, 0.2, 0.0));
  }
  expect_position(result.position(5), {6.0, 0.8, 0.0});
  EXPECT_NEAR(result.count("largest_closing_error"), 0.0, 1e-12);
}

TEST(Uniform, RotatesAboutTheStartOfTheLoop) {
  // The end of 4 m along x is measured at 4 m along y, rotated by 90 degrees: dt is zero, so each
  // pose rotates about the start by its share of 90 degrees.
  Problem problem = along_x({7, 8, 9, 10, 11, 12});
  const Vector3 start(7.0, 0.0, 0.0);
  const double quarter = 0.5 * std::numbers::pi;
  problem.closures = {closure(0, 4, {0.0, 4.0, 0.0}, quarter)};
  const Result result = corrected(problem);
  for (std::size_t i = 0; i < 5; ++i) {
    const double radius = static_cast<double>(i);
    const double angle = 0.25 * radius * quarter;
    EXPECT_NEAR(result.yaw(i), angle, 1e-12);
    expect_position(result.position(i),
                    start + radius * Vector3(std::cos(angle), std::sin(angle), 0.0));
  }
  EXPECT_NEAR(result.yaw(5), quarter, 1e-12);  // moves rigidly with the end
  expect_position(result.position(5), {7.0, 5.0, 0.0});
}

TEST(Uniform, WithRotationNoneOnlyPositionsMove) {
  Problem problem = along_x({0, 1, 2, 3, 4, 5});
  problem.closures = {closure(0, 4, {0.0, 4.0, 0.0}, 1.0)};
  const Result result = corrected(problem, option("rotation", "none"));
  for (std::size_t i = 0; i < 6; ++i) {
    const double share = std::min(0.25 * static_cast<double>(i), 1.0);
    EXPECT_EQ(result.yaw(i), 0.0);
    expect_position(
        result.position(i),
        problem.keyframes[i].world_from_body.translation + share * Vector3(-4.0, 4.0, 0.0));
  }
}

TEST(Uniform, WeighsByTimeDistanceAndRotation) {
  Problem problem = along_x({0, 1, 4, 4}, {0.0, 5.0, 6.0, 10.0});
  problem.keyframes[2].world_from_body.rotation = exp_so3({0.0, 0.0, 0.3});
  problem.keyframes[3].world_from_body.rotation = exp_so3({0.0, 0.0, 0.4});
  problem.closures = {closure(0, 3, {4.0, 0.0, 1.0}, 0.4)};
  const auto heights = [&](const std::string& weights) {
    const Result result = corrected(problem, option("weights", weights));
    return Vector3(result.position(1).z(), result.position(2).z(), result.position(3).z());
  };
  EXPECT_TRUE(heights("index").isApprox(Vector3(1.0 / 3.0, 2.0 / 3.0, 1.0), 1e-12));
  EXPECT_TRUE(heights("time").isApprox(Vector3(0.5, 0.6, 1.0), 1e-12));
  EXPECT_TRUE(heights("distance").isApprox(Vector3(0.25, 1.0, 1.0), 1e-12));
  EXPECT_TRUE(heights("rotation").isApprox(Vector3(0.0, 0.75, 1.0), 1e-12));
}

TEST(Uniform, FallsBackToIndexForZeroWeightsAndReportsIt) {
  Problem problem = along_x({0, 0, 0});
  problem.closures = {closure(0, 2, {0.0, 1.0, 0.0})};
  const Result result = corrected(problem, option("weights", "distance"));
  expect_position(result.position(1), {0.0, 0.5, 0.0});
  ASSERT_EQ(result.report.notes.size(), 1u);
  EXPECT_EQ(result.report.notes[0],
            "1 closures: distance is zero along the loop, distributed by index");
}

TEST(Uniform, ClosesSeparateLoopsExactly) {
  for (const char* overlap : {"all", "open"}) {
    const Problem problem =
        with_closures(hand_held(), hand_held_truth(), {{2, 20}, {20, 30}, {35, 50}});
    const Result result = corrected(problem, option("overlap", overlap));
    EXPECT_NEAR(result.count("largest_closing_error"), 0.0, 1e-12);
    for (const Edge& loop : problem.closures)
      EXPECT_NEAR(closing_error(loop, result.poses), 0.0, 1e-12);
  }
}

TEST(Uniform, AnOverlappingLoopReopensTheEarlierOneOnlyWithWhole) {
  // First 0 -> 2 is lifted to 1 m; then 1 -> 4 lifts its end from 1 m to 0.5 + 2 m.
  Problem problem = along_x({0, 1, 2, 3, 4});
  problem.closures = {closure(0, 2, {2.0, 0.0, 1.0}), closure(1, 4, {3.0, 0.0, 2.0})};
  const Result whole = corrected(problem);
  expect_position(whole.position(2), {2.0, 0.0, 1.5});  // 1 + a third of 1.5
  expect_position(whole.position(3), {3.0, 0.0, 2.0});
  expect_position(whole.position(4), {4.0, 0.0, 2.5});
  EXPECT_NEAR(whole.count("largest_closing_error"), 0.5, 1e-12);
  const Result open = corrected(problem, option("overlap", "open"));
  expect_position(open.position(2), {2.0, 0.0, 1.0});  // unchanged
  expect_position(open.position(3), {3.0, 0.0, 1.75});
  expect_position(open.position(4), {4.0, 0.0, 2.5});
  EXPECT_NEAR(open.count("largest_closing_error"), 0.0, 1e-12);
}

TEST(Uniform, OpenIgnoresALoopInsideAnEarlierOneAndReportsIt) {
  Problem problem = along_x({0, 1, 2, 3});
  problem.closures = {closure(0, 3, {3.0, 0.3, 0.0}), closure(1, 3, {2.0, 7.0, 0.0})};
  const Result result = corrected(problem, option("overlap", "open"));
  expect_position(result.position(3), {3.0, 0.3, 0.0});
  ASSERT_EQ(result.report.notes.size(), 1u);
  EXPECT_EQ(result.report.notes[0], "1 closures: ignored, every step lies inside an earlier loop");
}

TEST(Uniform, RecoversACircleWithConstantYawDrift) {
  // Even distribution assumes a constant bias per step, so most of the error must vanish.
  const Problem drifted = circle(41, 0.01);
  const Problem truth = circle(41, 0.0);
  const double before = largest_distance(drifted.keyframes, truth.keyframes);
  EXPECT_GT(before, 1.5);
  EXPECT_LT(largest_distance(corrected(drifted).poses, truth.keyframes), 0.5 * before);
}

}  // namespace
}  // namespace loopbench::test::uniform_test
