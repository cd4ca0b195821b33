/// Right data that `doctor` once accused.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <random>

#include "tests/metrics/doctor_pairs.hpp"

namespace loopbench::test::doctor_accusations_test {
namespace {

/// A square of 120 keyframes with loops between them, noise of the odometry and steady drift.
Problem square(unsigned seed, const std::vector<std::pair<std::size_t, std::size_t>>& loops) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto noise = [&] {
    const auto vector = [&] { return Vector3(normal(random), normal(random), normal(random)); };
    return exp_se3(twist(0.03 * vector(), 0.01 * vector()));
  };
  Problem out;
  Matrix6 information = Matrix6::Zero();
  information.diagonal() << Vector3::Constant(1.0 / 0.0009), Vector3::Constant(1e4);
  Trajectory truth{{0.0, {}}};
  out.keyframes = truth;
  for (std::size_t i = 1; i < 120; ++i) {
    const Pose step{exp_so3({0, 0, i % 30 == 0 ? 0.5 * M_PI : 0.0}), {1, 0, 0}};
    const double stamp = 0.1 * static_cast<double>(i);
    truth.push_back({stamp, normalized(truth.back().world_from_body * step)});
    out.odometry.push_back({i - 1, i, normalized(step * noise()), information});
    out.keyframes.push_back(
        {stamp,
         normalized(out.keyframes.back().world_from_body * out.odometry.back().from_from_to)});
  }
  for (const auto& [from, to] : loops) {
    const Pose loop = truth[from].world_from_body.inverse() * truth[to].world_from_body;
    out.closures.push_back({from, to, normalized(loop * noise()), information});
  }
  return out;
}

std::vector<std::pair<std::size_t, std::size_t>> many_loops() {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (std::size_t i = 0; i < 10; ++i) out.emplace_back(i, 110 + (i * 7) % 10);
  return out;
}

TEST(DoctorAccusations, OneOrTwoLoopsShowNoConvention) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    EXPECT_THAT(check_closures(square(seed, {{0, 119}})), IsEmpty()) << seed;
    EXPECT_THAT(check_closures(square(seed, {{0, 118}, {3, 119}})), IsEmpty()) << seed;
  }
}

/// A new map begins in the middle, which the odometry states: nothing contradicts it.
TEST(DoctorAccusations, AStepOfAnyDeviation) {
  Problem problem = square(1, many_loops());
  problem.odometry[60].information = Matrix6::Identity() / (9999.0 * 9999.0);
  problem.odometry[60].from_from_to = {exp_so3({0.1, 0.2, 3.4}), {30, -20, 1}};
  EXPECT_THAT(check_closures(problem), IsEmpty());
}

/// The scale of monocular odometry drifts to a third, as the loops state.
TEST(DoctorAccusations, ScalesOfEdges) {
  Problem problem = square(2, many_loops());
  const auto scale = [](std::size_t i) { return std::pow(3.0, static_cast<double>(i) / 120.0); };
  for (auto* edges : {&problem.odometry, &problem.closures}) {
    for (Edge& edge : *edges) edge.from_from_to.translation /= scale(edge.from);
  }
  for (Edge& edge : problem.closures) edge.scale = scale(edge.to) / scale(edge.from);
  EXPECT_THAT(check_closures(problem), IsEmpty());
}

TEST(DoctorAccusations, NamesTheIdsOfTheFile) {
  Problem problem = square(3, many_loops());
  problem.closures[4].from_from_to.translation += Vector3(8, 5, 0);
  for (std::size_t i = 0; i < problem.keyframes.size(); ++i)
    problem.ids.push_back(static_cast<std::int64_t>(i + 1));
  const InputFinding found = only(check_closures(problem), Fault::closure_gap);
  const Edge& wrong = problem.closures[4];
  EXPECT_THAT(found.evidence,
              HasSubstr("1 of 10 closures contradict the odometry or other closures"));
  EXPECT_THAT(found.evidence, HasSubstr(fmt::format("{} -> {} (", wrong.from + 1, wrong.to + 1)));
}

/// Its alignment leaves the rotation about the corridor open.
TEST(DoctorAccusations, AStraightCorridorIsNotMirrored) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Trajectory reference, estimate;
    double roll = 0.0, yaw = 0.0;
    for (int i = 0; i < 800; ++i) {
      const double t = 0.05 * i, speed = 1.0 + 0.4 * std::sin(0.3 * t);
      roll = 0.98 * roll + 0.01 * normal(random);
      yaw = 0.98 * yaw + 0.01 * normal(random);
      const Vector3 at(t * speed, 0.05 * std::sin(0.5 * t), 0.02 * std::cos(0.8 * t));
      const Pose pose{exp_so3({roll, 0, yaw}), at};
      const auto noise = [&] {
        return 0.02 * Vector3(normal(random), normal(random), normal(random));
      };
      reference.push_back({t, pose});
      estimate.push_back({t, {pose.rotation * exp_so3(0.1 * noise()), at + noise()}});
    }
    EXPECT_THAT(faults(reference, estimate), IsEmpty()) << seed;
  }
}

/// A robot in a plane, whose heading drifts so far that its path fits better upside down.
TEST(DoctorAccusations, HeadingsThatDriftAreNotMirrored) {
  for (const double drift : {0.02, 0.04, 0.06, 0.08}) {
    Trajectory reference{{0.0, {}}}, estimate{{0.0, {}}};
    for (int i = 1; i < 2000; ++i) {
      const double t = 0.1 * i, yaw_rate = 0.5 * std::sin(0.2 * t) + 0.4 * std::sin(0.071 * t);
      const auto step = [&](double rate) {
        return Pose{exp_so3({0, 0, 0.1 * rate}), {0.1 * (0.5 + 0.2 * std::sin(0.4 * t)), 0, 0}};
      };
      reference.push_back({t, normalized(reference.back().world_from_body * step(yaw_rate))});
      estimate.push_back({t, normalized(estimate.back().world_from_body * step(yaw_rate + drift))});
    }
    EXPECT_THAT(faults(reference, estimate), IsEmpty()) << drift;
  }
}

/// The reference begins before the estimate, whose stamps are those of every other frame.
TEST(DoctorAccusations, HalfTheRateIsNoOtherRecording) {
  for (const double factor : {0.5, 2.0}) {
    Trajectory estimate = sampled(20);
    estimate.erase(estimate.begin(), estimate.begin() + 80);
    const double begin = estimate.front().stamp;
    for (StampedPose& pose : estimate) pose.stamp = begin + factor * (pose.stamp - begin);
    EXPECT_THAT(faults(truth(), estimate), ElementsAre(Fault::missing_poses)) << factor;
  }
}

/// Stamps of 30 Hz were written after a third of the frames had been dropped at random.
TEST(DoctorAccusations, DroppedFramesAreNoOtherRecording) {
  std::mt19937 random(5);
  Trajectory estimate;
  for (std::size_t i = 0; 30 * i < 100 * 40; ++i) {
    const Pose& pose = truth()[100 * i / 30].world_from_body;
    if (random() % 3 != 0) estimate.push_back({static_cast<double>(estimate.size()) / 30.0, pose});
  }
  EXPECT_THAT(faults(truth(), estimate), ElementsAre(Fault::missing_poses));
}

/// Row i of the estimate is row i + 1 of the reference; the first was not written.
TEST(DoctorAccusations, RowsThatAreShiftedByOne) {
  Trajectory reference, estimate;
  for (std::size_t i = 0; i + 10 < truth().size(); i += 10) {
    const double stamp = 0.1 * static_cast<double>(reference.size());
    reference.push_back({stamp, truth()[i].world_from_body});
    estimate.push_back({stamp, truth()[i + 10].world_from_body});
  }
  const auto found = diagnosis(reference, estimate, "gt.txt", "run.txt", false).findings;
  EXPECT_THAT(only(found, Fault::time_offset).evidence,
              HasSubstr("row i of the estimate belongs to row i + 1 of the reference"));
}

}  // namespace
}  // namespace loopbench::test::doctor_accusations_test
