#include <cmath>
#include <random>

#include "datasets/core/mirrored.hpp"
#include "datasets/core/se3.hpp"
#include "tests/metrics/doctor_pairs.hpp"

namespace loopbench::test::doctor_clock_test {
namespace {

/// Rows of the truth at 10 Hz from `first` on, as readers stamp rows.
Trajectory rows(std::size_t first) {
  Trajectory out;
  for (std::size_t i = 10 * first; i < truth().size(); i += 10) {
    out.push_back({0.1 * static_cast<double>(out.size()), truth()[i].world_from_body});
  }
  return out;
}

std::vector<InputFinding> found_in_rows(const Trajectory& estimate) {
  return diagnosis(rows(0), estimate, "reference.txt", "run.txt", false).findings;
}

TEST(DoctorOfClocks, ARecordingThatWasPlayedFaster) {
  for (const auto& [begin, duration] : {std::pair{1.0, 0.5}, {3.0, 0.837}}) {
    Trajectory estimate = sampled(20);
    for (StampedPose& pose : estimate) pose.stamp = begin + duration * (pose.stamp - 1.0);
    EXPECT_THAT(faults(truth(), estimate), ElementsAre(Fault::missing_poses)) << duration;
    const InputFinding found = only_finding(truth(), estimate, Fault::missing_poses);
    EXPECT_NEAR(found.value, 1.0 / duration, 0.02);
  }
}

/// A reference of a fraction of a second has no mean speed.
TEST(DoctorOfClocks, AReferenceOfAnInstant) {
  Trajectory reference;
  for (std::size_t i = 0; i < 30; ++i) {
    reference.push_back({20.0 + 0.01 * static_cast<double>(i), truth()[i].world_from_body});
  }
  const auto found = diagnosis(reference, sampled(20), "reference.txt", "run.txt").findings;
  for (const InputFinding& each : found) EXPECT_TRUE(std::isfinite(each.value)) << each.evidence;
}

TEST(DoctorOfClocks, NumbersOfImagesThatBeginLate) {
  Trajectory estimate;
  for (std::size_t i = 0; i < truth().size(); i += 10) {
    estimate.push_back({5000.0 + static_cast<double>(estimate.size()), truth()[i].world_from_body});
  }
  EXPECT_THAT(faults(truth(), estimate), ElementsAre(Fault::no_overlap));
}

TEST(DoctorOfClocks, RowsThatBeginLate) {
  const InputFinding found = only(found_in_rows(rows(30)), Fault::time_offset);
  EXPECT_NEAR(found.value, 3.0, 0.05);
  EXPECT_THAT(found_in_rows(rows(0)), IsEmpty());
}

TEST(DoctorOfClocks, NothingIsFoundInAReferenceAtRest) {
  Trajectory reference = truth();
  for (StampedPose& pose : reference) pose.world_from_body = Pose{};
  for (const auto& finding : diagnosis(reference, sampled(20), "a.txt", "b.txt").findings) {
    EXPECT_EQ(finding.fault, Fault::constant_rotation) << text(finding);
  }
}

TEST(DoctorOfClocks, AnEmptyReference) { EXPECT_THAT(faults({}, sampled(20)), IsEmpty()); }

TEST(DoctorOfClocks, ALeftHandedWorldIsOneFinding) {
  const auto mirror = [](const Pose& p) { return mirrored(p, 1); };
  const InputFinding found = only_finding(truth(), each(sampled(20), mirror), Fault::mirrored);
  EXPECT_THAT(found.fix, HasSubstr("--mirror "));
}

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
  const InputFinding found = only_finding(reference, estimate, Fault::time_offset);
  EXPECT_NEAR(found.value, -18.0, 0.02);
}

/// Clocks that were set after the first pose, or two sessions: a search with a constant step over
/// all that time takes days.
TEST(TimeOffset, StampsFarApartNeedABoundedSearch) {
  constexpr double kEpoch = 1.7e9, kMonth = 30.0 * 86'400.0;
  Trajectory reference = truth(), estimate = sampled(20);
  for (Trajectory* poses : {&reference, &estimate}) {
    for (StampedPose& pose : *poses) pose.stamp += kEpoch;
  }
  EXPECT_THAT(faults(reference, estimate), IsEmpty());
  Trajectory stray_reference = reference, stray_estimate = estimate;
  stray_reference.front().stamp = stray_estimate.front().stamp = 0.0;
  EXPECT_THAT(faults(reference, stray_estimate), IsEmpty());
  EXPECT_THAT(faults(stray_reference, estimate), IsEmpty());
  EXPECT_THAT(faults(stray_reference, stray_estimate), IsEmpty());
  for (Trajectory* poses : {&reference, &estimate}) {
    for (StampedPose& pose : *poses) {
      if (pose.stamp > kEpoch + 20.0) pose.stamp += kMonth;
    }
  }
  EXPECT_THAT(faults(reference, estimate), IsEmpty());
}

}  // namespace
}  // namespace loopbench::test::doctor_clock_test
