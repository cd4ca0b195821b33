#include <gtest/gtest.h>

#include <numbers>

#include "datasets/simulated/path.hpp"
#include "datasets/simulated/simulated.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::simulated_path_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Statistics of a sequence in the paper, at keyframes.
struct Statistics {
  double seconds, metres, slowest, fastest, mean;  // [s], [m], [m/s]
  double turn_rate;                                // mean rotation rate [deg/s]
  Vector3 box;                                     // [m]
};

Statistics statistics(const Trajectory& poses) {
  Statistics out{};
  double turned = 0.0;
  Vector3 low = poses.front().world_from_body.translation, high = low;
  out.slowest = 1e9;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Pose& a = poses[i - 1].world_from_body;
    const Pose& b = poses[i].world_from_body;
    const double speed =
        (b.translation - a.translation).norm() / (poses[i].stamp - poses[i - 1].stamp);
    out.slowest = std::min(out.slowest, speed);
    out.fastest = std::max(out.fastest, speed);
    turned += angle_between(a.rotation, b.rotation);
    low = low.cwiseMin(b.translation);
    high = high.cwiseMax(b.translation);
  }
  out.seconds = poses.back().stamp - poses.front().stamp;
  out.metres = path_length(poses);
  out.mean = out.metres / out.seconds;
  out.turn_rate = turned / out.seconds * 180.0 / kPi;
  out.box = high - low;
  return out;
}

/// True poses of the path at keyframe stamps.
Trajectory true_keyframes(SimulatedPath which) {
  SimulatedOptions options;
  options.path = which;
  options.noise.gain = 0.0;
  return load_simulated(options).problem.keyframes;
}

/// Expects the statistics of the recording, up to these differences.
void expect_statistics(SimulatedPath which,
                       std::size_t keyframes,
                       const Statistics& expected,
                       const Statistics& difference) {
  const Trajectory poses = true_keyframes(which);
  EXPECT_EQ(poses.size(), keyframes);
  const Statistics found = statistics(poses);
  for (const auto member : {&Statistics::seconds,
                            &Statistics::metres,
                            &Statistics::slowest,
                            &Statistics::fastest,
                            &Statistics::mean,
                            &Statistics::turn_rate}) {
    EXPECT_NEAR(found.*member, expected.*member, difference.*member);
  }
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found.box[i], expected.box[i], difference.box[i]);
}

TEST(SimulatedPath, RoomAndOfficeHaveTheStatisticsOfTheirRecordings) {
  expect_statistics(SimulatedPath::room,  // fr1_room
                    180,
                    {48.90, 15.99, 0.06, 0.70, 0.327, 29.9, {2.5, 2.2, 0.5}},
                    {0.01, 0.05, 0.005, 0.01, 0.001, 3.0, {0.02, 0.02, 0.02}});
  expect_statistics(SimulatedPath::office,  // fr3_office
                    204,
                    {87.09, 21.455, 0.037, 0.43, 0.246, 10.2, {5.1, 4.9, 0.54}},
                    {0.03, 0.05, 0.003, 0.01, 0.001, 1.5, {0.02, 0.02, 0.02}});
}

TEST(SimulatedPath, HandHeldLoopsEndNearTheirStartLookingTheSameWay) {
  for (const Path& path : {room_path(), office_path()}) {
    const Pose begin_from_end = path.at(0.0).inverse() * path.at(path.duration);
    EXPECT_LT(begin_from_end.translation.norm(), 0.1);
    EXPECT_GT(begin_from_end.translation.norm(), 0.001) << "hand-held laps must not repeat exactly";
    EXPECT_LT(log_so3(begin_from_end.rotation).norm(), 5.0 * kPi / 180.0);
  }
}

TEST(SimulatedPath, RoomLooksOutwardsAndOfficeInwards) {
  double room = 0.0, office = 0.0;
  for (double share = 0.0; share < 1.0; share += 0.01) {
    const auto outwards = [&](const Path& path) {
      const Pose pose = path.at(share * path.duration);
      return (pose.rotation * Vector3::UnitX()).dot(pose.translation.normalized());
    };
    room += 0.01 * outwards(room_path());
    office += 0.01 * outwards(office_path());
  }
  EXPECT_GT(room, 0.5);
  EXPECT_LT(office, -0.5);
}

TEST(SimulatedPath, DrivingIsAKilometreWithStopsAndFastRoads) {
  const Path path = driving_path();
  double metres = 0.0, fastest = 0.0, standing = 0.0;
  const double dt = 0.01;
  for (double t = dt; t < path.duration; t += dt) {
    const double step = (path.at(t).translation - path.at(t - dt).translation).norm();
    metres += step;
    fastest = std::max(fastest, step / dt);
    if (step == 0.0) standing += dt;
  }
  EXPECT_NEAR(metres, 1045.7, 1.0);  // 1080 m of streets, shortened by (4 - pi) * 4 m in 10 corners
  EXPECT_GT(fastest, 13.0);
  EXPECT_LT(fastest, 16.0);
  EXPECT_NEAR(standing, 4.0 + 6.0 + 3.0 + 8.0 + 2.0, 0.2);
}

TEST(SimulatedPath, DrivingComesBackExactly) {
  const Path path = driving_path();
  EXPECT_POSE_NEAR(path.at(0.0), path.at(path.duration - 1e-9), 1e-8, 1e-8);
  EXPECT_POSE_NEAR(path.at(7.0), path.at(7.0 + path.duration), 1e-9, 1e-9);
}

TEST(SimulatedPath, DrivingHeadsWhereItGoes) {
  const Path path = driving_path();
  for (double t = 0.05; t < path.duration; t += 0.1) {
    const Pose pose = path.at(t);
    const Vector3 motion = path.at(t + 1e-4).translation - pose.translation;
    if (motion.norm() < 1e-5) continue;  // below 0.1 m/s
    EXPECT_GT((pose.rotation * Vector3::UnitX()).dot(motion.normalized()), 1.0 - 1e-6) << t;
  }
}

TEST(SimulatedPath, NothingJumps) {
  for (const auto& [name, which] : choices(SimulatedPath{})) {
    const Path path = path_of(which);
    const double dt = 1e-3;
    Pose before = path.at(0.0);
    Vector3 speed_before = (path.at(dt).translation - before.translation) / dt;
    for (double t = dt; t < 2.0 * path.duration; t += dt) {
      const Pose now = path.at(t);
      const Vector3 speed = (now.translation - before.translation) / dt;
      ASSERT_LT((speed - speed_before).norm(), 0.01) << name << " at " << t;  // 10 m/s^2
      ASSERT_LT(angle_between(before.rotation, now.rotation), 4.0 * dt) << name << " at " << t;
      speed_before = speed;
      before = now;
    }
  }
}

TEST(SimulatedPath, DegenerateOnesAreWhatTheyAreCalled) {
  const Statistics line = statistics(true_keyframes(SimulatedPath::line));
  EXPECT_NEAR(line.metres, 30.0, 1e-9);
  EXPECT_NEAR(line.box.tail<2>().norm(), 0.0, 1e-12);
  EXPECT_EQ(line.turn_rate, 0.0);
  const Statistics still = statistics(true_keyframes(SimulatedPath::still));
  EXPECT_EQ(still.metres, 0.0);
  EXPECT_EQ(still.turn_rate, 0.0);
  const Statistics spin = statistics(true_keyframes(SimulatedPath::spin));
  EXPECT_EQ(spin.metres, 0.0);
  EXPECT_NEAR(spin.turn_rate, 18.0, 1e-9);
}

}  // namespace
}  // namespace loopbench::simulated_path_test
