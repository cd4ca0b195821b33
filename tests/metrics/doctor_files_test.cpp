/// Findings of `doctor` about whole files: stamps, gaps, jumps, content.
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/metrics/doctor_pairs.hpp"

namespace loopbench::test::doctor_files_test {
namespace {

TEST(Doctor, FilesWithoutCommonTime) {
  Trajectory in_milliseconds = sampled(20), other = sampled(20);
  for (StampedPose& pose : in_milliseconds) pose.stamp *= 1000.0;
  EXPECT_THAT(faults(truth(), in_milliseconds), ElementsAre(Fault::stamp_unit));
  EXPECT_THAT(faults(in_milliseconds, sampled(20)), ElementsAre(Fault::stamp_unit));
  for (StampedPose& pose : other) {
    // Another recording: constant speed, no rotation.
    pose = {pose.stamp + 5000.0, {Rotation::Identity(), {pose.stamp, 0, 0}}};
  }
  EXPECT_THAT(faults(truth(), other), testing::Contains(Fault::no_overlap));
}

TEST(Doctor, NamesWhatCannotBeChecked) {
  const Diagnosis single = diagnosis(truth(), {sampled(20)[3]}, "gt.txt", "run.txt");
  EXPECT_THAT(single.findings, IsEmpty());
  EXPECT_FALSE(single.has_checked);
  EXPECT_THAT(
      single.unchecked,
      ElementsAre(HasSubstr("time offset: "),
                  HasSubstr("same recording: poses of the estimate in the reference's time: 1, ")));
  const Diagnosis good = diagnosis(truth(), sampled(20), "gt.txt", "run.txt");
  EXPECT_TRUE(good.has_checked);
  EXPECT_THAT(good.unchecked, IsEmpty());
}

TEST(Doctor, ExchangedFilesByName) {
  const auto all = diagnosis(sampled(20), truth(), "run.txt", "groundtruth.txt").findings;
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all[0].fault, Fault::swapped);
  EXPECT_THAT(diagnosis(truth(), sampled(20), "gt.txt", "gt_odometry.txt").findings, IsEmpty());
  for (const char* name : {"vo_aligned_to_gt.txt", "vicon_room1/orbslam3.txt"}) {
    EXPECT_THAT(diagnosis(truth(), sampled(20), "data.csv", name).findings, IsEmpty());
  }
}

/// References from surveys and lidar scans have a lower rate than inertial odometry.
TEST(Doctor, AReferenceOfALowerRateIsNotExchanged) {
  for (const std::size_t step : {20u, 100u}) {
    Trajectory reference;
    for (std::size_t i = 100; i + 200 < truth().size(); i += step) reference.push_back(truth()[i]);
    EXPECT_THAT(diagnosis(reference, sampled(20), "lidar.txt", "run.txt").findings, IsEmpty())
        << step;
  }
}

/// Noise has no common motion that could be compared.
TEST(Doctor, ARecordingAtRestCannotBeCompared) {
  std::mt19937 random(3);
  for (const double of_reference : {0.0, 1e-4}) {
    for (const double motion : {0.0, 0.01}) {
      std::normal_distribution<double> small(0.0, of_reference), large(0.0, 0.02);
      Trajectory reference, estimate;
      for (int i = 0; i < 500; ++i) {
        const double t = 1000.0 + 0.05 * i;
        const Vector3 at(1.0 + motion * std::sin(0.3 * t), 2.0, 3.0 + motion * std::cos(0.2 * t));
        const auto noise = [&](auto& normal) {
          return Vector3(normal(random), normal(random), normal(random));
        };
        reference.push_back({t, {Rotation::Identity(), at + noise(small)}});
        estimate.push_back({t, {Rotation::Identity(), at + noise(large)}});
      }
      const Diagnosis out = diagnosis(reference, estimate, "reference.txt", "run.txt");
      EXPECT_THAT(out.findings, IsEmpty()) << of_reference << " " << motion;
      EXPECT_THAT(out.unchecked, testing::Contains(HasSubstr("same recording: ")));
    }
  }
}

/// Every fifth pose of the truth, so that errors hide no small offset.
Trajectory without_errors() {
  Trajectory out;
  for (std::size_t i = 100; i + 100 < truth().size(); i += 5) out.push_back(truth()[i]);
  return out;
}

TEST(Doctor, HalfAFrameOfOffset) {
  for (const double offset : {0.025, -0.025}) {
    Trajectory estimate = without_errors();
    for (StampedPose& pose : estimate) pose.stamp += offset;
    EXPECT_THAT(faults(truth(), estimate), ElementsAre(Fault::time_offset)) << offset;
  }
}

TEST(Doctor, FrameIndicesAsStamps) {
  Trajectory estimate = sampled(20);
  for (std::size_t i = 0; i < estimate.size(); ++i) estimate[i].stamp = static_cast<double>(i);
  const InputFinding found = only_finding(truth(), estimate, Fault::no_overlap);
  EXPECT_NEAR(found.value, 0.05, 1e-3);
}

TEST(Doctor, Jumps) {
  Trajectory estimate = sampled(20);
  for (std::size_t i = 300; i < estimate.size(); ++i) {
    estimate[i].world_from_body.translation.x() += 2.0;
  }
  const InputFinding found = only_finding(truth(), estimate, Fault::jumps);
  EXPECT_THAT(found.evidence, HasSubstr(" 16.000 s"));
}

TEST(Doctor, OutliersOfPositions) {
  Trajectory estimate = sampled(20);
  for (std::size_t i = 100; i < 700; i += 100) {
    estimate[i].world_from_body.translation.x() += 2.0;
  }
  const InputFinding found = only_finding(truth(), estimate, Fault::jumps);
  EXPECT_EQ(found.value, 6.0);
  EXPECT_THAT(found.evidence, HasSubstr(" and 1 more time: without"));
}

TEST(Doctor, AnOutlierOfTheFewestPosesLeavesTooFew) {
  Trajectory reference = truth(), estimate = sampled(2);
  reference.resize(1100);
  estimate.resize(20);
  estimate[9].world_from_body.translation.x() += 40.0;
  const Diagnosis found = diagnosis(reference, estimate, "reference.txt", "run.txt");
  only(found.findings, Fault::jumps);
  EXPECT_THAT(found.unchecked, ElementsAre(HasSubstr("in the reference's time: 19, expected")));
}

/// The path of another day, with other curves at other times.
TEST(Doctor, AnotherRecording) {
  Trajectory other;
  for (double t = 0.0; t < 41.0; t += 0.05) {
    other.push_back(
        {t,
         {exp_so3({0, 0, 0.9 * std::sin(0.37 * t + 1)}) * exp_so3({0.2 * std::cos(2.1 * t), 0, 0}),
          {3 * std::sin(0.23 * t), 2 * std::cos(0.71 * t), std::sin(1.1 * t)}}});
  }
  EXPECT_THAT(faults(truth(), other), ElementsAre(Fault::wrong_recording));
}

/// The rotations of another recording, and positions that drift by half their spread.
TEST(Doctor, AWeakFindingReplacesNoOther) {
  for (const double drift : {2.2, 2.4, 2.6}) {
    Trajectory estimate = sampled(20);
    for (auto& [t, pose] : estimate) {
      pose.rotation =
          exp_so3({0, 0, 0.9 * std::sin(0.37 * t + 1)}) * exp_so3({0.2 * std::cos(2.1 * t), 0, 0});
      pose.translation += drift * Vector3(std::sin(0.2 * t), std::cos(0.2 * t), 0);
    }
    SCOPED_TRACE(drift);
    only(diagnosis(truth(), estimate, "run.txt", "groundtruth.txt").findings, Fault::swapped);
  }
}

/// Total stations measure positions at a low rate.
TEST(Doctor, AReferenceWithoutRotationsIsNotExchanged) {
  Trajectory reference;
  for (std::size_t i = 0; i < truth().size(); i += 20) {
    reference.push_back(
        {truth()[i].stamp, {Rotation::Identity(), truth()[i].world_from_body.translation}});
  }
  EXPECT_THAT(faults(reference, truth()), ElementsAre(Fault::constant_rotation));
}

TEST(Doctor, PrintsWhatARepairChanges) {
  const auto exchanged = each(sampled(20), [](const Pose& p) -> Pose {
    return {p.rotation, {p.translation.y(), p.translation.x(), p.translation.z()}};
  });
  const InputFinding found = only_finding(truth(), exchanged, Fault::mirrored);
  EXPECT_THAT(found.evidence,
              HasSubstr("taking y,x,z as x,y,z in the positions of the estimate: "));
  EXPECT_THAT(found.evidence, HasSubstr(" -> "));
}

}  // namespace
}  // namespace loopbench::test::doctor_files_test
