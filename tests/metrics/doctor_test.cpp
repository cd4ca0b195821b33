#include <algorithm>
#include <cmath>
#include <functional>

#include "metrics/doctor/pair_checks.hpp"
#include "tests/metrics/doctor_pairs.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::test::doctor_test {
namespace {

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

struct Convention {
  const char* name;
  std::function<Pose(const Pose&)> change;  ///< of the estimate's poses
  std::vector<Fault::Name> faults;
};

/// A pose with changed position.
template <class Change>
auto positions(Change change) {
  return [change](const Pose& p) -> Pose { return {p.rotation, change(p.translation)}; };
}

auto times(double factor) {
  return positions([factor](const Vector3& v) { return Vector3(factor * v); });
}

TEST(Doctor, ConventionsOfPoses) {
  const Convention conventions[] = {
      {"quaternion z w x y", misordered, {Fault::quaternion_order}},
      {"quaternion x y z w",
       [](const Pose& p) -> Pose {
         const Rotation& q = p.rotation;
         return {Rotation(q.x(), q.y(), q.z(), q.w()), p.translation};
       },
       {Fault::quaternion_order}},
      {"inverted", [](const Pose& p) { return p.inverse(); }, {Fault::inverted_poses}},
      {"conjugated", conjugated, {Fault::inverted_poses}},
      {"inverted positions",
       [](const Pose& p) -> Pose {
         return {p.rotation, -(p.rotation.conjugate() * p.translation)};
       },
       {Fault::inverted_poses}},
      {"no rotation",
       [](const Pose& p) -> Pose {
         return {Rotation::Identity(), p.translation};
       },
       {Fault::constant_rotation}},
      {"y mirrored",
       positions([](const Vector3& v) { return Vector3(v.x(), -v.y(), v.z()); }),
       {Fault::mirrored}},
      {"axes y z x",
       positions([](const Vector3& v) { return Vector3(v.y(), v.z(), v.x()); }),
       {Fault::axes}},
      {"millimetres", times(1000.0), {Fault::scale}},
      {"scale 0.4", times(0.4), {Fault::scale}},
      {"scale 1.08", times(1.08), {Fault::scale}},
      {"scale 1.15", times(1.15), {Fault::scale}},
      {"scale 1.03", times(1.03), {}},
  };
  for (const auto& [name, change, expected] : conventions) {
    EXPECT_EQ(faults(truth(), each(sampled(20), change)), expected) << name;
  }
  EXPECT_THAT(faults(each(truth(), misordered), sampled(20)), ElementsAre(Fault::quaternion_order));
}

/// A drive in camera axes: right, down, forward. The reference pitches and rolls by `tilt` [rad].
Trajectory drive(double tilt, double phase) {
  Trajectory out;
  for (int i = 0; i < 400; ++i) {
    const double t = 0.25 * i;
    const double yaw = 0.06 * t + 0.8 * std::sin(0.11 * t + phase);
    const Rotation tilted =
        exp_so3({tilt * std::sin(0.7 * t), 0, tilt * std::cos(1.1 * t + phase)});
    const Vector3 position{
        30.0 * std::sin(0.08 * t + phase) + 0.5 * t, 0, 40.0 * std::cos(0.05 * t)};
    out.push_back({t, {exp_so3({0, yaw, 0}) * tilted, position}});
  }
  return out;
}

TEST(Doctor, PlanarQuaternionsInCameraAxes) {
  for (int i = 0; i < 24; ++i) {
    const double phase = 0.26 * i;
    const Trajectory reference = drive(0.002 * (i % 6), phase);
    const Trajectory estimate = drive(0.0, phase);
    EXPECT_THAT(faults(reference, estimate), IsEmpty()) << i;
    EXPECT_THAT(faults(estimate, reference), IsEmpty()) << i;
    EXPECT_THAT(faults(reference, each(estimate, misordered)), ElementsAre(Fault::quaternion_order))
        << i;
  }
}

TEST(Doctor, AxesOfAnotherBody) {
  const Rotation camera(0.5, -0.5, 0.5, -0.5);
  const auto turned = [&](const Pose& p) -> Pose { return {p.rotation * camera, p.translation}; };
  EXPECT_THAT(faults(each(truth(), turned), sampled(20)), ElementsAre(Fault::other_body));
  EXPECT_THAT(faults(drive(0.01, 0.3), each(drive(0.0, 0.3), turned)),
              ElementsAre(Fault::other_body));
  const InputFinding found = only_finding(each(truth(), turned), truth(), Fault::other_body);
  EXPECT_NEAR(found.value, 2.0 * M_PI / 3.0, 1e-6);
  EXPECT_THAT(found.fix, testing::StartsWith("--ref-body=0.0,0.0,0.0,"));
  const auto mounted = [](const Pose& p) -> Pose {
    return {p.rotation * exp_so3({0.1, 0.25, 0}), p.translation};
  };
  EXPECT_THAT(faults(each(truth(), mounted), truth()), ElementsAre(Fault::other_body));
  // The alignment of a straight path leaves the rotation about it open.
  Trajectory straight, rolled;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.1 * i;
    const Pose pose{exp_so3({0.01 * std::sin(t), 0, 0}), {t * (1.0 + 0.3 * std::sin(t)), 0, 0}};
    straight.push_back({t, pose});
    rolled.push_back({t, {exp_so3({2.0, 0, 0}) * pose.rotation, pose.translation}});
  }
  EXPECT_THAT(faults(straight, rolled), IsEmpty());
}

TEST(Doctor, InvertedRotationsOfSmallSize) {
  // Rotations mostly about one axis, so that their inverses fit after a constant rotation by 180
  // deg but for 6 deg.
  const auto path = [](double rate) {
    Trajectory out;
    for (double t = 0.0; t < 40.0; t += 1.0 / rate) {
      out.push_back({t,
                     {exp_so3({0, 0, 0.6 * t}) *
                          exp_so3({0.09 * std::sin(0.9 * t), 0.08 * std::cos(1.3 * t), 0}),
                      at(t).translation}});
    }
    return out;
  };
  EXPECT_THAT(faults(path(100), path(20)), IsEmpty());
  EXPECT_THAT(faults(path(100), each(path(20), conjugated)), ElementsAre(Fault::inverted_poses));
}

/// Rotations mostly about one axis, whose inverses fit after a constant rotation; heading drifts.
TEST(Doctor, InvertedRotationsUnderDrift) {
  const Trajectory reference = hand_held_truth(120);
  const Trajectory estimate =
      drifting(reference, twist({0.004, 0, 0.001}, {0, 0.001, 0.002}), {}).keyframes;
  EXPECT_THAT(faults(reference, estimate), IsEmpty());
  EXPECT_THAT(faults(reference, each(estimate, conjugated)), ElementsAre(Fault::inverted_poses));
  EXPECT_THAT(faults(each(reference, conjugated), estimate), ElementsAre(Fault::inverted_poses));
}

TEST(Doctor, ConventionsAreComparedAtTheTimeOffset) {
  EXPECT_THAT(faults(truth(), each(sampled(20, 0.2), misordered)),
              ElementsAre(Fault::time_offset, Fault::quaternion_order));
}

TEST(Doctor, PeriodicSpeedsHaveNoOffset) {
  // The speed has a period of 9.4 s, so offsets of 9.4 s fit as well as none.
  Trajectory reference, estimate;
  for (int i = 0; i < 600; ++i) {
    const double t = 0.1 * i, period = 3.0 * M_PI;
    const double s = t + 0.5 * std::sin(2.0 * M_PI * t / period);
    const Pose pose{exp_so3({0, 0, 0.2 * s}),
                    {5.0 * std::sin(0.2 * s), -5.0 * std::cos(0.2 * s), 0}};
    reference.push_back({t, pose});
    const double error = 1e-6 * ((i * 7919) % 13 - 6);
    estimate.push_back({t, {pose.rotation, pose.translation + Vector3(error, -error, 0)}});
  }
  EXPECT_THAT(faults(reference, estimate), IsEmpty());
  for (StampedPose& pose : estimate) pose.stamp -= 0.5;
  const auto found = estimate_time_offset(reference, estimate);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->offset, 0.5, 0.01);
}

/// Odometry with a constant bias on a circle at constant speed: all offsets correlate equally.
TEST(Doctor, AnOffsetThatDoesNotRaiseTheCorrelationIsNoFinding) {
  for (const double bias : {0.003, 0.01, 0.04}) {
    Trajectory reference, estimate;
    for (int i = 0; i < 240; ++i) {
      const double t = 0.1 * i, angle = 0.1 * M_PI * t;
      reference.push_back(
          {t, {exp_so3({0, 0, angle}), {5 * std::cos(angle), 5 * std::sin(angle), 0}}});
      if (i == 0) {
        estimate = reference;
        continue;
      }
      const Pose step = reference[reference.size() - 2].world_from_body.inverse() *
                        reference.back().world_from_body;
      const Pose error = exp_se3(0.1 * bias * twist({1, -0.5, 0.3}, {-0.4, 0.7, 0.2}));
      estimate.push_back({t, normalized(estimate.back().world_from_body * step * error)});
    }
    EXPECT_THAT(faults(reference, estimate), testing::Not(testing::Contains(Fault::time_offset)))
        << bias;
  }
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
  const auto mirrored = positions([](const Vector3& v) { return Vector3(-v.x(), v.y(), v.z()); });
  const auto has_axes = [](const Trajectory& estimate) {
    const std::vector<Fault::Name> all = faults(driven(0.0), estimate);
    return std::ranges::find(all, Fault::mirrored) != all.end();
  };
  for (const double drift : {0.1, 0.5, 1.5, 3.0}) {
    EXPECT_FALSE(has_axes(driven(drift))) << drift;
    EXPECT_TRUE(has_axes(each(driven(drift), mirrored))) << drift;
  }
}

TEST(Doctor, LeverArm) {
  const Pose other{Rotation::Identity(), {0.5, -0.3, 0.2}};
  const Trajectory estimate = each(sampled(20), [&](const Pose& p) { return p * other; });
  const InputFinding found = only_finding(truth(), estimate, Fault::other_body);
  EXPECT_NEAR(found.value, other.translation.norm(), 0.05);
  EXPECT_THAT(found.fix, testing::StartsWith("--ref-body="));
}

}  // namespace
}  // namespace loopbench::test::doctor_test
