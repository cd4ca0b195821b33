#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/core/mirrored.hpp"
#include "tests/metrics/doctor_pairs.hpp"

namespace loopbench::doctor_clock_test {
namespace {

using namespace metrics;
using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;

/// Every `step`-th row of the truth at 10 Hz from `first` on, as readers stamp rows.
Trajectory rows(std::size_t first, std::size_t step = 1) {
  Trajectory out;
  for (std::size_t i = 10 * first; i < truth().size(); i += 10 * step) {
    out.push_back({0.1 * static_cast<double>(out.size()), truth()[i].world_from_body});
  }
  return out;
}

std::vector<InputFinding> found_in_rows(const Trajectory& estimate) {
  return diagnosis(rows(0), estimate, "reference.txt", "run.txt", false).findings;
}

TEST(DoctorOfClocks, ARecordingThatWasPlayedFaster) {
  Trajectory estimate = sampled(20);
  for (StampedPose& pose : estimate) pose.stamp = 1.0 + 0.5 * (pose.stamp - 1.0);
  EXPECT_THAT(faults(truth(), estimate), ElementsAre(Fault::clock_drift));
}

TEST(DoctorOfClocks, ARecordingAtARateThatIsNotRound) {
  Trajectory estimate = sampled(20);
  for (StampedPose& pose : estimate) pose.stamp = 3.0 + 0.837 * (pose.stamp - 1.0);
  const auto found = diagnosis(truth(), estimate, "reference.txt", "run.txt").findings;
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].fault, Fault::clock_drift);
  EXPECT_NEAR(found[0].value, 1.0 / 0.837, 0.005);
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
  EXPECT_THAT(faults(truth(), estimate), ElementsAre(Fault::frame_indices));
}

TEST(DoctorOfClocks, AJump) {
  Trajectory estimate = sampled(20);
  for (StampedPose& pose : estimate) pose.stamp += pose.stamp > 24.0 ? 1.5 : 0.0;
  const auto found = diagnosis(truth(), estimate, "reference.txt", "run.txt").findings;
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].fault, Fault::clock_drift);
  EXPECT_THAT(found[0].evidence, HasSubstr("the estimate's clock jumps"));
  EXPECT_NEAR(found[0].value, 1.5, 0.05);
}

TEST(DoctorOfClocks, RowsThatBeginLate) {
  const auto found = found_in_rows(rows(30));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].fault, Fault::time_offset);
  EXPECT_NEAR(found[0].value, 3.0, 0.05);
  EXPECT_THAT(found_in_rows(rows(0)), testing::IsEmpty());
}

TEST(DoctorOfClocks, EveryThirdRow) {
  const auto found = found_in_rows(rows(0, 3));
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].fault, Fault::frame_indices);
  EXPECT_NEAR(found[0].value, 3.0, 0.01);
}

TEST(DoctorOfClocks, NothingIsFoundInAReferenceAtRest) {
  Trajectory reference = truth();
  for (StampedPose& pose : reference) pose.world_from_body = Pose{};
  for (const auto& finding : diagnosis(reference, sampled(20), "a.txt", "b.txt").findings) {
    EXPECT_EQ(finding.fault, Fault::constant_rotation) << text(finding);
  }
}

TEST(DoctorOfClocks, AnEmptyReference) { EXPECT_THAT(faults({}, sampled(20)), testing::IsEmpty()); }

TEST(DoctorOfClocks, ALeftHandedWorldIsOneFinding) {
  const auto mirror = [](const Pose& p) { return mirrored(p, 1); };
  const auto found =
      diagnosis(truth(), each(sampled(20), mirror), "reference.txt", "run.txt").findings;
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].fault, Fault::axes);
  EXPECT_THAT(found[0].fix, HasSubstr("--mirror "));
}

TEST(DoctorOfClocks, ManyOutliers) {
  Trajectory estimate = sampled(20);
  for (std::size_t i = 15; i < estimate.size(); i += 40) {
    estimate[i].world_from_body.translation += Vector3(0, 0, 6);
  }
  EXPECT_THAT(faults(truth(), estimate), ElementsAre(Fault::jumps));
}

}  // namespace
}  // namespace loopbench::doctor_clock_test
