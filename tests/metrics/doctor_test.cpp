#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "metrics/doctor/closure_checks.hpp"
#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/diagnose.hpp"
#include "metrics/doctor/movement.hpp"
#include "metrics/doctor/time_offset.hpp"

namespace loopbench::doctor_test {
namespace {

using namespace metrics;
using testing::ElementsAre;
using testing::IsEmpty;

/// A path through space with varied speed and rotation about all axes.
Pose at(double t) {
  const Vector3 phi(0.5 * std::sin(0.9 * t), 0.4 * std::cos(1.3 * t), 0.6 * t);
  return {exp_so3({0, 0, phi.z()}) * exp_so3({phi.x(), phi.y(), 0}),
          {4 * std::cos(0.6 * t + 0.2 * std::sin(t)), 3 * std::sin(0.6 * t), std::sin(0.35 * t)}};
}

Trajectory sampled(double rate, double offset = 0.0) {
  // Small errors that a tracker makes; in another world and body frame.
  const Pose world{exp_so3({0.1, -0.2, 1.0}), {5, 6, 7}};
  const Pose body{exp_so3({0.2, 0.1, -0.3}), Vector3::Zero()};
  Trajectory out;
  for (double t = 1.0; t < 40.0; t += 1.0 / rate) {
    const Pose error{exp_so3(0.004 * Vector3(std::sin(31 * t), std::cos(47 * t), std::sin(23 * t))),
                     0.004 * Vector3(std::cos(29 * t), std::sin(37 * t), std::sin(41 * t))};
    out.push_back({t - offset, normalized(world * at(t) * error * body)});
  }
  return out;
}

const Trajectory& truth() {
  static const Trajectory out = [] {
    Trajectory poses;
    for (double t = 0.0; t < 41.0; t += 0.01) poses.push_back({t, at(t)});
    return poses;
  }();
  return out;
}

template <class Change>
Trajectory each(Trajectory poses, Change change) {
  for (auto& [stamp, pose] : poses) pose = change(pose);
  return poses;
}

std::vector<Fault> faults(const Trajectory& reference, const Trajectory& estimate) {
  std::vector<Fault> out;
  for (const InputFinding& finding : diagnose(reference, estimate, "reference.txt", "run.txt")) {
    EXPECT_GT(finding.confidence, 0.0) << text(finding);
    EXPECT_LE(finding.confidence, 1.0) << text(finding);
    out.push_back(finding.fault);
  }
  return out;
}

TEST(Doctor, FindsNothingInGoodFiles) { EXPECT_THAT(faults(truth(), sampled(20)), IsEmpty()); }

TEST(Doctor, TimeOffsetIsEstimatedWithItsUncertainty) {
  for (const double offset : {0.13, -2.4, 3000.0}) {
    const auto found = estimate_time_offset(truth(), sampled(20, offset));
    ASSERT_TRUE(found) << offset;
    EXPECT_NEAR(found->offset, offset, 0.005);
    EXPECT_LT(std::abs(found->offset - offset), 5.0 * found->deviation + 1e-4);
    EXPECT_THAT(faults(truth(), sampled(20, offset)), ElementsAre(Fault::time_offset));
  }
}

TEST(Doctor, QuaternionOrder) {
  const auto wrong = [](const Pose& p) -> Pose {
    return {Rotation(p.rotation.z(), p.rotation.w(), p.rotation.x(), p.rotation.y()),
            p.translation};
  };
  EXPECT_THAT(faults(truth(), each(sampled(20), wrong)), ElementsAre(Fault::quaternion_order));
  EXPECT_THAT(faults(each(truth(), wrong), sampled(20)), ElementsAre(Fault::quaternion_order));
}

TEST(Doctor, InvertedPosesAndRotations) {
  EXPECT_THAT(faults(truth(), each(sampled(20), [](const Pose& p) { return p.inverse(); })),
              ElementsAre(Fault::inverted_poses));
  const auto conjugated = [](const Pose& p) -> Pose {
    return {p.rotation.conjugate(), p.translation};
  };
  EXPECT_THAT(faults(truth(), each(sampled(20), conjugated)), ElementsAre(Fault::conjugated));
}

TEST(Doctor, MirroredAndPermutedAxes) {
  const auto mirrored = [](const Pose& p) -> Pose {
    return {p.rotation, {p.translation.x(), -p.translation.y(), p.translation.z()}};
  };
  const auto permuted = [](const Pose& p) -> Pose {
    return {p.rotation, {p.translation.y(), p.translation.z(), p.translation.x()}};
  };
  EXPECT_THAT(faults(truth(), each(sampled(20), mirrored)), ElementsAre(Fault::axes));
  EXPECT_THAT(faults(truth(), each(sampled(20), permuted)), ElementsAre(Fault::axes));
}

/// A car on a plane whose heading drifts by `drift` at the end [rad].
Trajectory driven(double drift) {
  Trajectory out;
  Pose pose;
  for (int i = 0; i <= 1200; ++i) {
    const double t = 0.1 * i;
    out.push_back({t, pose});
    const double turn = 0.15 * std::max(0.0, std::sin(0.2 * t)) + drift / 120.0;  // [rad/s]
    pose = pose * Pose{exp_so3({0, 0, 0.1 * turn}), {0.1 * (8.0 + std::sin(0.7 * t)), 0, 0}};
  }
  return out;
}

TEST(Doctor, DriftIsNoFaultOfAxesAndHidesNone) {
  const auto mirrored = [](const Pose& p) -> Pose {
    return {p.rotation, {-p.translation.x(), p.translation.y(), p.translation.z()}};
  };
  const auto has_axes = [](const Trajectory& estimate) {
    const std::vector<Fault> all = faults(driven(0.0), estimate);
    return std::ranges::find(all, Fault::axes) != all.end();
  };
  for (const double drift : {0.1, 0.5, 1.5, 3.0}) {
    EXPECT_FALSE(has_axes(driven(drift))) << drift;
    EXPECT_TRUE(has_axes(each(driven(drift), mirrored))) << drift;
  }
}

TEST(Doctor, UnitsAndScale) {
  const auto times = [](double factor) {
    return [factor](const Pose& p) -> Pose { return {p.rotation, factor * p.translation}; };
  };
  EXPECT_THAT(faults(truth(), each(sampled(20), times(1000.0))), ElementsAre(Fault::length_unit));
  EXPECT_THAT(faults(truth(), each(sampled(20), times(0.4))), ElementsAre(Fault::scale));
  EXPECT_THAT(faults(truth(), each(sampled(20), times(1.03))), IsEmpty());
}

TEST(Doctor, ExchangedFilesByNameOrRate) {
  const auto all = diagnose(sampled(20), truth(), "run.txt", "groundtruth.txt");
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all[0].fault, Fault::swapped);
  EXPECT_THAT(diagnose(truth(), sampled(20), "gt.txt", "gt_odometry.txt"), IsEmpty());
}

/// Two rounds on a circle with closures between them, and drift in the odometry.
Problem rounds() {
  Problem out;
  const std::size_t round = 60;
  const auto pose = [&](std::size_t i) {
    const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(round);
    const Pose on_circle{exp_so3({0, 0, angle}),
                         {20 * std::sin(angle), 20 - 20 * std::cos(angle), 0}};
    // On another lane in the second round.
    return on_circle * Pose{Rotation::Identity(), {0, i < round ? 0.0 : 1.5, 0}};
  };
  const auto noise = [](std::size_t i) {
    const auto k = static_cast<double>(i);
    return exp_se3(twist(0.02 * Vector3(std::sin(k * k), std::cos(3 * k * k), std::sin(k + 1)),
                         0.004 * Vector3(std::sin(5 * k * k), std::cos(k * k), std::sin(2 * k))));
  };
  Matrix6 information = Matrix6::Zero();
  information.diagonal() << 2500, 2500, 2500, 62500, 62500, 62500;
  for (std::size_t i = 0; i < 2 * round; ++i) {
    out.keyframes.push_back({static_cast<double>(i), pose(i)});
    if (i == 0) continue;
    out.odometry.push_back({i - 1, i, pose(i - 1).inverse() * pose(i) * noise(i), information});
  }
  for (std::size_t i = 0; i + 4 < round; i += 2) {
    // Measured from one keyframe before the revisited place, so that the inverse differs.
    out.closures.push_back({i,
                            i + round + 1,
                            pose(i).inverse() * pose(i + round + 1) * noise(7 * i + 3),
                            information});
  }
  return out;
}

std::vector<Fault> closure_faults(const Problem& problem) {
  std::vector<Fault> out;
  for (const InputFinding& finding : check_closures(problem)) out.push_back(finding.fault);
  return out;
}

TEST(DoctorOfClosures, FindsNothingInAGoodGraph) {
  EXPECT_THAT(closure_faults(rounds()), IsEmpty());
}

TEST(DoctorOfClosures, InvertedClosures) {
  Problem problem = rounds();
  for (Edge& edge : problem.closures) edge.from_from_to = edge.from_from_to.inverse();
  EXPECT_THAT(closure_faults(problem), ElementsAre(Fault::closure_direction));
}

TEST(DoctorOfClosures, AFalseClosure) {
  Problem problem = rounds();
  problem.closures.push_back({10, 40, Pose{}, problem.closures[0].information});
  EXPECT_THAT(closure_faults(problem), ElementsAre(Fault::closure_gap));
}

TEST(DoctorOfClosures, InformationInTheWrongOrderOrScale) {
  Problem problem = rounds();
  for (auto* edges : {&problem.odometry, &problem.closures}) {
    for (Edge& edge : *edges) edge.information *= 1e4;
  }
  EXPECT_THAT(closure_faults(problem), ElementsAre(Fault::information_scale));
  problem = rounds();
  for (auto* edges : {&problem.odometry, &problem.closures}) {
    for (Edge& edge : *edges) edge.information.diagonal().reverseInPlace();
  }
  EXPECT_THAT(closure_faults(problem), ElementsAre(Fault::information_order));
}

/// Without neighbours, and with too little drift to hide the motion between the lanes.
TEST(DoctorOfClosures, FewClosuresAreComparedWithTheOdometry) {
  Problem problem = rounds();
  problem.closures = {problem.closures[0], problem.closures[13], problem.closures[26]};
  EXPECT_THAT(closure_faults(problem), IsEmpty());
  Problem inverted = problem;
  for (Edge& edge : inverted.closures) edge.from_from_to = edge.from_from_to.inverse();
  EXPECT_THAT(closure_faults(inverted), ElementsAre(Fault::closure_direction));
  for (auto* edges : {&problem.odometry, &problem.closures}) {
    for (Edge& edge : *edges) edge.information *= 1e4;
  }
  EXPECT_THAT(closure_faults(problem), ElementsAre(Fault::information_scale));
}

TEST(DoctorOfClosures, AFalseClosureWithinTheUsualDriftContradictsItsCovariance) {
  Problem problem = rounds();
  // The gap is 30 % of the loop's length, most loops drift by 5 %.
  for (Edge& edge : problem.odometry) edge.from_from_to.translation *= 1.06;
  const Pose true_pose =
      problem.keyframes[10].world_from_body.inverse() * problem.keyframes[110].world_from_body;
  problem.closures.push_back({10,
                              110,
                              Pose{true_pose.rotation, true_pose.translation + Vector3(0, 0, 60)},
                              problem.closures[0].information});
  EXPECT_THAT(closure_faults(problem), ElementsAre(Fault::closure_gap));
}

TEST(DoctorOfCorrections, ClosuresThatMoveNothing) {
  Problem problem = rounds();
  Trajectory chained{{0.0, problem.keyframes[0].world_from_body}};
  for (const Edge& step : problem.odometry) {
    chained.push_back({static_cast<double>(step.to),
                       normalized(chained.back().world_from_body * step.from_from_to)});
  }
  problem.keyframes = chained;
  const auto found = check_movement(problem, chained);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->fault, Fault::nothing_moved);
  Trajectory moved = chained;
  moved.back().world_from_body.translation.x() += 0.5;
  EXPECT_FALSE(check_movement(problem, moved));
  problem.closures.clear();
  EXPECT_FALSE(check_movement(problem, chained));
}

TEST(CommonMotion, FindsThePoseAtOrAfterAStampFromAnyHint) {
  Trajectory poses;
  for (const double stamp : {0.0, 1.0, 1.5, 1.6, 4.0, 9.0, 9.5}) poses.push_back({stamp, {}});
  for (const double stamp : {-1.0, 0.0, 0.5, 1.0, 1.55, 4.0, 8.0, 9.5, 10.0}) {
    const auto expected = std::ranges::lower_bound(poses, stamp, {}, &StampedPose::stamp);
    for (std::size_t hint = 0; hint <= poses.size() + 1; ++hint) {
      EXPECT_EQ(first_from(poses, stamp, hint), static_cast<std::size_t>(expected - poses.begin()))
          << stamp << " from " << hint;
    }
  }
  EXPECT_EQ(first_from({}, 1.0, 0), 0u);
  EXPECT_DOUBLE_EQ(usual_interval(poses), 1.0);
}

}  // namespace
}  // namespace loopbench::doctor_test
