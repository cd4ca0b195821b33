/// Findings of `doctor` about rows that are wrong: repeated, jumping, in another order.
#include <algorithm>
#include <string>
#include <vector>

#include "tests/metrics/doctor_pairs.hpp"

namespace loopbench::test::doctor_rows_test {
namespace {

TEST(DoctorOfRows, MissingPoses) {
  Trajectory estimate = sampled(20);
  estimate.erase(estimate.begin() + 200, estimate.begin() + 450);
  EXPECT_THAT(faults(truth(), estimate), ElementsAre(Fault::missing_poses));
}

TEST(DoctorOfRows, LostPosesAtTheOriginAndManyOutliers) {
  Trajectory lost = sampled(20), outliers = sampled(20);
  for (std::size_t i = 301; i < 320; ++i) lost[i].world_from_body = Pose{};
  for (std::size_t i = 15; i < outliers.size(); i += 40) {
    outliers[i].world_from_body.translation += Vector3(0, 0, 6);
  }
  EXPECT_THAT(faults(truth(), lost), ElementsAre(Fault::jumps));
  EXPECT_THAT(faults(truth(), outliers), ElementsAre(Fault::jumps));
}

TEST(DoctorOfRows, AnOutlierOfTheFewestPosesHidesNoRotations) {
  Trajectory few = sampled(2.5);
  few.resize(20);
  few[10].world_from_body.translation.x() += 6.0;
  const Diagnosis found = diagnosis(truth(), few, "reference.txt", "run.txt");
  EXPECT_THAT(found.findings.back().evidence, HasSubstr("position jumps at"));
  EXPECT_THAT(found.unchecked, ElementsAre(HasSubstr("reference's time: 19, expected at least")));
}

TEST(DoctorOfRows, AGapOfBothIsNoMistake) {
  const auto interrupted = [](Trajectory poses, const Rotation& world) {
    std::erase_if(poses, [](const StampedPose& p) { return p.stamp > 15.0 && p.stamp < 25.0; });
    for (auto& [stamp, pose] : poses) {
      if (stamp > 15.0) pose.translation += world * Vector3(60.0, 0.0, 0.0);
    }
    return poses;
  };
  EXPECT_THAT(faults(interrupted(truth(), Rotation::Identity()),
                     interrupted(sampled(20), exp_so3({0.1, -0.2, 1.0}))),
              testing::IsEmpty());
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
  EXPECT_THAT(faults(paused(truth()), paused(sampled(20))), IsEmpty());
}

TEST(DoctorOfRows, OutliersOfTheReference) {
  Trajectory reference = truth();
  for (std::size_t i = 203; i < reference.size(); i += 400) {
    reference[i].world_from_body.translation.z() += 9.0;
  }
  const InputFinding found = only_finding(reference, sampled(20), Fault::jumps);
  EXPECT_THAT(found.evidence, HasSubstr("the reference's position jumps at 2.030 s"));
}

/// Stamps of ten loops between the poses.
std::vector<double> loop_stamps(double factor = 1.0, double offset = 0.0) {
  std::vector<double> out;
  for (std::size_t i = 0; i < 20; ++i) {
    out.push_back(factor * sampled(20)[7 * i + i * i % 5].stamp + offset);
  }
  return out;
}

/// Value of the finding, which must be of that fault.
double value_of(const std::vector<double>& loops, const Trajectory& poses) {
  const auto found = check_loop_stamps(loops, poses);
  EXPECT_TRUE(found && found->fault == Fault::loop_stamps) << (found ? text(*found) : "no finding");
  return found ? found->value : 0.0;
}

TEST(DoctorOfLoopStamps, ThoseOfPosesAreRight) {
  EXPECT_FALSE(check_loop_stamps(loop_stamps(), sampled(20)));
  EXPECT_FALSE(check_loop_stamps({}, sampled(20)));
  EXPECT_FALSE(check_loop_stamps(loop_stamps(), {}));
}

TEST(DoctorOfLoopStamps, Milliseconds) {
  EXPECT_DOUBLE_EQ(value_of(loop_stamps(1e3), sampled(20)), 1e3);
}

TEST(DoctorOfLoopStamps, NumbersOfPoses) {
  Trajectory poses = sampled(20);
  for (StampedPose& pose : poses) pose.stamp += 1e9;
  value_of({3, 500, 7, 510, 12, 511}, poses);
}

TEST(DoctorOfLoopStamps, AnotherClock) {
  Trajectory keyframes;  // at irregular times
  for (std::size_t i = 0; i < sampled(20).size(); i += 3 + i * i % 5) {
    keyframes.push_back(sampled(20)[i]);
  }
  std::vector<double> loops;
  for (std::size_t i = 0; i < 20; ++i) loops.push_back(keyframes[4 * i].stamp - 1.23);
  EXPECT_NEAR(value_of(loops, keyframes), 1.23, 1e-9);
  value_of(loop_stamps(1.0, 5000.0), sampled(20));
}

}  // namespace
}  // namespace loopbench::test::doctor_rows_test
