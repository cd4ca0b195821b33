/// Findings of `doctor` about rows that are wrong: repeated, jumping, in another order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "metrics/doctor/graph_checks.hpp"
#include "tests/metrics/doctor_pairs.hpp"

namespace loopbench::doctor_rows_test {
namespace {

using namespace metrics;
using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(DoctorOfRows, PosesThatStayWhileTrackingIsLost) {
  Trajectory estimate = sampled(20);
  for (std::size_t i = 301; i < 360; ++i)
    estimate[i].world_from_body = estimate[300].world_from_body;
  const auto found = diagnosis(truth(), estimate, "reference.txt", "run.txt").findings;
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].fault, Fault::missing_poses);
  EXPECT_EQ(found[0].value, 59.0);
  EXPECT_THAT(found[0].evidence, HasSubstr("59 poses of the estimate repeat the one before"));
}

TEST(DoctorOfRows, LostPosesAtTheOrigin) {
  Trajectory estimate = sampled(20);
  for (std::size_t i = 301; i < 320; ++i) estimate[i].world_from_body = Pose{};
  EXPECT_THAT(faults(truth(), estimate), ElementsAre(Fault::jumps));
}

TEST(DoctorOfRows, ATruePauseOfBothIsNoMistake) {
  const auto paused = [](Trajectory poses) {
    for (StampedPose& pose : poses) {
      if (pose.stamp > 12.0) pose.stamp += 5.0;
    }
    Trajectory out;
    for (const StampedPose& pose : poses) {
      while (!out.empty() && pose.stamp - out.back().stamp > 0.15) {
        out.push_back({out.back().stamp + 0.1, out.back().world_from_body});
      }
      out.push_back(pose);
    }
    return out;
  };
  EXPECT_THAT(faults(paused(truth()), paused(sampled(20))), testing::IsEmpty());
}

TEST(DoctorOfRows, OutliersOfTheReference) {
  Trajectory reference = truth();
  for (std::size_t i = 203; i < reference.size(); i += 400) {
    reference[i].world_from_body.translation.z() += 9.0;
  }
  const auto found = diagnosis(reference, sampled(20), "reference.txt", "run.txt").findings;
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].fault, Fault::jumps);
  EXPECT_THAT(found[0].evidence, HasSubstr("the reference's position jumps at 2.030 s"));
}

/// Rows as a shell lists the files 0.txt, 1.txt, ...: 10 before 2.
TEST(DoctorOfRows, OrderOfNames) {
  const Trajectory estimate = sampled(20);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < estimate.size(); ++i) names.push_back(std::to_string(i));
  std::ranges::sort(names);
  Trajectory listed = estimate;
  for (std::size_t i = 0; i < names.size(); ++i) {
    listed[i].world_from_body = estimate[std::stoul(names[i])].world_from_body;
  }
  const auto found = diagnosis(truth(), listed, "reference.txt", "run.txt").findings;
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].fault, Fault::jumps);
  EXPECT_THAT(found[0].evidence, HasSubstr("the rows of the estimate are in alphabetical order"));
}

TEST(DoctorOfRows, ASmallScale) {
  EXPECT_THAT(faults(truth(),
                     each(sampled(20),
                          [](const Pose& p) -> Pose {
                            return {p.rotation, 1.15 * p.translation};
                          })),
              ElementsAre(Fault::scale));
}

/// Stamps of ten loops between the poses.
std::vector<double> loop_stamps(double factor = 1.0, double offset = 0.0) {
  std::vector<double> out;
  for (std::size_t i = 0; i < 20; ++i) {
    out.push_back(factor * sampled(20)[7 * i + i * i % 5].stamp + offset);
  }
  return out;
}

TEST(DoctorOfLoopStamps, ThoseOfPosesAreRight) {
  EXPECT_FALSE(check_loop_stamps(loop_stamps(), sampled(20)));
  EXPECT_FALSE(check_loop_stamps({}, sampled(20)));
  EXPECT_FALSE(check_loop_stamps(loop_stamps(), {}));
}

TEST(DoctorOfLoopStamps, Milliseconds) {
  const auto found = check_loop_stamps(loop_stamps(1e3), sampled(20));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->fault, Fault::stamp_unit);
  EXPECT_DOUBLE_EQ(found->value, 1e3);
}

TEST(DoctorOfLoopStamps, NumbersOfPoses) {
  Trajectory poses = sampled(20);
  for (StampedPose& pose : poses) pose.stamp += 1e9;
  const auto found = check_loop_stamps({3, 500, 7, 510, 12, 511}, poses);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->fault, Fault::frame_indices);
}

TEST(DoctorOfLoopStamps, AnotherClock) {
  Trajectory keyframes;  // at irregular times
  for (std::size_t i = 0; i < sampled(20).size(); i += 3 + i * i % 5) {
    keyframes.push_back(sampled(20)[i]);
  }
  std::vector<double> loops;
  for (std::size_t i = 0; i < 20; ++i) loops.push_back(keyframes[4 * i].stamp - 1.23);
  const auto found = check_loop_stamps(loops, keyframes);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->fault, Fault::time_offset);
  EXPECT_NEAR(found->value, 1.23, 1e-9);
  const auto other = check_loop_stamps(loop_stamps(1.0, 5000.0), sampled(20));
  ASSERT_TRUE(other);
  EXPECT_EQ(other->fault, Fault::no_overlap);
}

}  // namespace
}  // namespace loopbench::doctor_rows_test
