/// Offsets of clocks of any size, with their intervals.
#include <cmath>
#include <random>

#include "metrics/doctor/pair_checks.hpp"
#include "tests/metrics/doctor_pairs.hpp"

namespace loopbench::test::doctor_offset_test {
namespace {

double varied_speed(double t) {
  return 5.0 + 2.0 * std::sin(0.31 * t) + 1.5 * std::sin(0.83 * t + 0.004 * t * t);
}

/// Of a heavy vehicle: speeds that are seconds apart are nearly the same.
double slow_speed(double t) {
  return 8.0 + 2.0 * std::sin(0.09 * t) + 1.5 * std::sin(0.05 * t + 1.0) + std::sin(0.031 * t);
}

/// A drive with curves: poses at `rate` [Hz] from `begin` to `end` [s].
Trajectory drive(double begin,
                 double end,
                 double rate,
                 double noise,
                 unsigned seed,
                 double (*speed_at)(double) = varied_speed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, noise > 0.0 ? noise : 1.0);
  Trajectory out;
  double x = 0.0, y = 0.0, heading = 0.0;
  constexpr double kStep = 0.01;
  const auto every = static_cast<int>(std::lround(1.0 / (rate * kStep)));
  for (int i = 0; kStep * i < end; ++i) {
    const double t = kStep * i;
    if (t >= begin && i % every == 0) {
      const auto error = [&] { return noise > 0.0 ? normal(random) : 0.0; };
      const Vector3 at(x + error(), y + error(), error());
      out.push_back({t, {exp_so3({0, 0, heading}), at}});
    }
    const double speed = speed_at(t);
    heading += kStep * (0.2 * std::sin(0.21 * t) + 0.1 * std::sin(0.003 * t * t));
    x += kStep * speed * std::cos(heading);
    y += kStep * speed * std::sin(heading);
  }
  return out;
}

Trajectory positions_of(Trajectory poses) {
  for (StampedPose& pose : poses) pose.world_from_body.rotation = no_rotation();
  return poses;
}

Trajectory shifted(Trajectory poses, double seconds) {
  for (StampedPose& pose : poses) pose.stamp += seconds;
  return poses;
}

TEST(OffsetOfClocks, OfNoisyPositionsIsWithinItsInterval) {
  constexpr int kSeeds = 60;
  int covered = 0;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    const double offset = -2.0 + 0.07 * seed;
    const Trajectory reference = positions_of(drive(3.0, 120.0, 5.0, 0.02, seed));
    const auto found = estimate_time_offset(
        reference, shifted(drive(0.0, 125.0, 50.0, 0.02, 1000 + seed), -offset));
    ASSERT_TRUE(found) << seed;
    EXPECT_NEAR(found->offset, offset, 0.05) << seed;
    covered += std::abs(found->offset - offset) < 2.1 * found->deviation;
  }
  EXPECT_GE(covered, 53);  // 95 % of 60 are 57; 53 has a probability of 3 %
}

/// At zero, the speeds over one second correlate by more than 0.97.
TEST(OffsetOfClocks, OfSlowlyChangingSpeedsIsBeyondTheSearchNearZero) {
  for (const double offset : {2.0, -2.0, 5.0}) {
    const auto found =
        estimate_time_offset(positions_of(drive(10.0, 320.0, 5.0, 0.02, 6, slow_speed)),
                             shifted(drive(0.0, 330.0, 10.0, 0.02, 7, slow_speed), -offset));
    ASSERT_TRUE(found) << offset;
    EXPECT_GT(found->before, 0.8);
    EXPECT_GT(found->correlation, 0.99);
    EXPECT_NEAR(found->offset, offset, 0.1);
    EXPECT_GT(found->deviation, 0.001);
    EXPECT_LT(std::abs(found->offset - offset), 4.0 * found->deviation);
  }
}

/// One file has rows without stamps, the other the time of day.
TEST(OffsetOfClocks, OfRowsIsSmallerThanTheFiles) {
  const Trajectory poses = drive(0.0, 60.0, 10.0, 0.02, 8);
  const TimeOffset found{.offset = 1.6e9,
                         .deviation = 0.01,
                         .agreement = 0.99,
                         .correlation = 0.99,
                         .has_common_time = false,
                         .odds = 100.0};
  EXPECT_FALSE(offset_finding(found, shifted(poses, 1.6e9), poses, false));
  EXPECT_TRUE(offset_finding(found, shifted(poses, 1.6e9), poses, true));
}

TEST(OffsetOfClocks, LeapsOfGpsTimeAreNamed) {
  const Trajectory reference = shifted(positions_of(drive(0.0, 100.0, 5.0, 0.02, 1)), 18.0);
  const InputFinding found =
      only_finding(reference, drive(0.0, 100.0, 10.0, 0.02, 2), Fault::time_offset);
  EXPECT_NEAR(found.value, 18.0, 0.03);
  EXPECT_THAT(found.evidence, HasSubstr("GPS time and UTC"));
}

TEST(OffsetOfClocks, UpToTheLengthOfTheRecordings) {
  for (const double offset : {12.0, -60.0, 5000.0}) {
    const auto found = estimate_time_offset(positions_of(drive(0.0, 200.0, 5.0, 0.02, 3)),
                                            shifted(drive(0.0, 200.0, 10.0, 0.02, 4), -offset));
    ASSERT_TRUE(found) << offset;
    EXPECT_NEAR(found->offset, offset, 0.05);
  }
}

/// Every lap fits every other one.
TEST(OffsetOfClocks, IsNotStatedForEqualLaps) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, 0.03);
  Trajectory reference, estimate;
  for (int i = 0; i < 1200; ++i) {
    const double t = 0.1 * i, phase = 2.0 * M_PI * t / 30.0;
    const double angle = phase + 0.4 * std::sin(phase);
    const Vector3 at(10.0 * std::cos(angle), 6.0 * std::sin(angle), 0.0);
    const auto noise = [&] { return Vector3(normal(random), normal(random), 0.0); };
    reference.push_back({t, {no_rotation(), at + noise()}});
    if (i < 900) estimate.push_back({t + 5000.0, {exp_so3({0, 0, angle}), at + noise()}});
  }
  EXPECT_FALSE(estimate_time_offset(reference, estimate));
}

}  // namespace
}  // namespace loopbench::test::doctor_offset_test
