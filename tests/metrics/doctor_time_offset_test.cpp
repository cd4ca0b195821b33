#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "metrics/doctor/diagnose.hpp"
#include "tests/metrics/doctor_pairs.hpp"

namespace loopbench::doctor_time_offset_test {
namespace {

using namespace metrics;

TEST(TimeOffset, IsNotFoundAtAConstantRateOfRotation) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, 0.05);
    const auto rounded = [](double x) { return 1e-9 * std::round(1e9 * x); };
    Trajectory reference, estimate;
    for (int i = 0; i < 200; ++i) {
      const double t = 1000.0 + 0.1 * i, angle = 0.5 * t;
      const Rotation rotation(rounded(std::cos(angle / 2)), 0, 0, rounded(std::sin(angle / 2)));
      const Vector3 p(5 * std::cos(angle), 5 * std::sin(angle), 0.1 * std::sin(3 * angle));
      reference.push_back({t, {rotation.normalized(), p}});
      estimate.push_back(
          {t, {rotation.normalized(), p + Vector3(noise(random), noise(random), noise(random))}});
    }
    for (const InputFinding& found :
         diagnosis(reference, estimate, "reference.txt", "run.txt").findings) {
      EXPECT_NE(found.fault, Fault::time_offset) << seed << ": " << text(found);
    }
  }
}

/// GPS time is 18 s ahead of UTC: the files still have common times.
TEST(TimeOffset, LargerThanTheNearestOnes) {
  Trajectory reference, estimate;
  Pose pose;
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.05 * i;
    reference.push_back({t, pose});
    if (i % 2 == 0) estimate.push_back({t + 18.0, pose});
    const double speed = 1.0 + 0.8 * std::sin(0.01 * t * t), rate = 0.5 * std::sin(0.007 * t * t);
    pose = normalized(pose * exp_se3(0.05 * twist({speed, 0, 0}, {0, 0.3 * rate, rate})));
  }
  const auto found = diagnosis(reference, estimate, "reference.txt", "run.txt").findings;
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].fault, Fault::time_offset);
  EXPECT_NEAR(found[0].value, -18.0, 0.02);
}

/// Clocks that were set after the first pose, or two sessions: a search with a constant step over
/// all that time takes days.
TEST(TimeOffset, StampsFarApartNeedABoundedSearch) {
  constexpr double kEpoch = 1.7e9, kMonth = 30.0 * 86'400.0;
  Trajectory reference = test::truth(), estimate = test::sampled(20);
  for (Trajectory* poses : {&reference, &estimate}) {
    for (StampedPose& pose : *poses) pose.stamp += kEpoch;
  }
  EXPECT_THAT(test::faults(reference, estimate), testing::IsEmpty());
  Trajectory stray_reference = reference, stray_estimate = estimate;
  stray_reference.front().stamp = stray_estimate.front().stamp = 0.0;
  EXPECT_THAT(test::faults(reference, stray_estimate), testing::IsEmpty());
  EXPECT_THAT(test::faults(stray_reference, estimate), testing::IsEmpty());
  EXPECT_THAT(test::faults(stray_reference, stray_estimate), testing::IsEmpty());
  for (Trajectory* poses : {&reference, &estimate}) {
    for (StampedPose& pose : *poses) {
      if (pose.stamp > kEpoch + 20.0) pose.stamp += kMonth;
    }
  }
  EXPECT_THAT(test::faults(reference, estimate), testing::IsEmpty());
}

}  // namespace
}  // namespace loopbench::doctor_time_offset_test
