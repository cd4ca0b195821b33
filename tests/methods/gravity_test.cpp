// Roll and pitch held as measured: what is kept, what is corrected, and what is declined.
#include "methods/correctors/gravity.hpp"

#include <gtest/gtest.h>

#include <random>

#include "methods/correctors/consensus.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::test::gravity_test {
namespace {

/// Angle between the vertical in the bodies of two poses [rad].
double tilt_between(const Pose& a, const Pose& b) {
  const Vector3 up = a.rotation.conjugate() * Vector3::UnitZ();
  return up.cross(b.rotation.conjugate() * Vector3::UnitZ()).norm();
}

double largest_tilt(const Trajectory& a, const Trajectory& b) {
  double out = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    out = std::max(out, tilt_between(a[i].world_from_body, b[i].world_from_body));
  }
  return out;
}

double position_error(const Trajectory& poses, const Trajectory& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    sum +=
        (poses[i].world_from_body.translation - truth[i].world_from_body.translation).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(poses.size()));
}

/// Two laps of the hand-held path whose odometry errs in position and in yaw alone, as odometry
/// with gravity does; closures err in all components (0.02 m, 0.01 rad), as stated.
struct Flight {
  Trajectory truth;
  Problem problem;
};

Flight flight(unsigned seed, double closure_sigma = 0.01) {
  Flight out;
  out.truth = hand_held_truth(160);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto normal3 = [&](double sigma) {
    return Vector3(sigma * normal(random), sigma * normal(random), sigma * normal(random));
  };
  const auto between = [](const Pose& a, const Pose& b) { return normalized(a.inverse() * b); };
  constexpr double kStep = 0.003, kYaw = 0.004, kClosure = 0.02;
  double yaw = 0.0;
  Problem& problem = out.problem;
  const auto information = [](double sigma_t, double sigma_r) {
    Matrix6 all = Matrix6::Zero();
    all.diagonal().head<3>().setConstant(1.0 / (sigma_t * sigma_t));
    all.diagonal().tail<3>().setConstant(1.0 / (sigma_r * sigma_r));
    return all;
  };
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    const Pose& pose = out.truth[i].world_from_body;
    if (i == 0) {
      problem.keyframes.push_back(out.truth[0]);
      continue;
    }
    const Vector3 step = pose.translation - out.truth[i - 1].world_from_body.translation;
    const Pose& before = problem.keyframes.back().world_from_body;
    Pose next{exp_so3({0.0, 0.0, yaw + kYaw * normal(random)}) * pose.rotation,
              before.translation + exp_so3({0.0, 0.0, yaw}) * step + normal3(kStep)};
    yaw = log_so3(next.rotation * pose.rotation.conjugate()).z();
    problem.odometry.push_back({i - 1, i, between(before, next), information(kStep, kYaw)});
    problem.keyframes.push_back({out.truth[i].stamp, next});
  }
  for (std::size_t i = 5; i + 80 < out.truth.size(); i += 15) {
    const Pose exact = between(out.truth[i].world_from_body, out.truth[i + 80].world_from_body);
    const Pose error{exp_so3(normal3(closure_sigma)), normal3(kClosure)};
    problem.closures.push_back({i, i + 80, normalized(exact * error), information(kClosure, 0.01)});
  }
  return out;
}

TEST(Gravity, HoldsRollAndPitchAndCorrectsYaw) {
  double with = 0.0, without = 0.0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const auto [truth, problem] = flight(seed);
    Report report;
    const Trajectory held = corrected<PoseGraphOptimizer>(problem, {.gravity = true}, &report);
    const Trajectory free = corrected<PoseGraphOptimizer>(problem);
    EXPECT_LT(largest_tilt(held, problem.keyframes), 1e-9);
    EXPECT_GT(largest_tilt(free, problem.keyframes), 1e-4);
    const double raw = position_error(problem.keyframes, truth);
    EXPECT_LT(position_error(held, truth), raw);
    with += position_error(held, truth);
    without += position_error(free, truth);
    EXPECT_NEAR(count(report, "tilt_error"), 0.01 * std::sqrt(2.0) * 180.0 / M_PI, 0.5);
    for (const std::string& note : report.notes) EXPECT_EQ(note.find("roll"), std::string::npos);
  }
  EXPECT_LT(with, without);
}

TEST(Gravity, IsAnOptionOfConsensus) {
  const auto [truth, problem] = flight(3);
  const Trajectory held = corrected<Consensus>(problem, {.gravity = true});
  EXPECT_LT(largest_tilt(held, problem.keyframes), 1e-9);
  EXPECT_LT(position_error(held, truth), position_error(problem.keyframes, truth));
}

// With closures that agree with the held roll and pitch, the cost is that of all components, with
// zero slope along positions and yaw about the vertical of the world.
TEST(Gravity, FindsTheMinimumInTheFreeDirections) {
  const Problem problem = flight(5, 0.0).problem;
  const Trajectory held = corrected<PoseGraphOptimizer>(problem, {.gravity = true});
  std::vector<Pose> poses;
  for (const StampedPose& each : held) poses.push_back(each.world_from_body);
  const double minimum = chain_cost(problem, poses);
  for (std::size_t i = 1; i < poses.size(); i += 7) {
    for (int d = 0; d < 4; ++d) {
      const auto cost = [&](double step) {
        std::vector<Pose> moved = poses;
        if (d < 3) {
          moved[i].translation[d] += step;
        } else {
          moved[i].rotation = exp_so3({0.0, 0.0, step}) * poses[i].rotation;
        }
        return chain_cost(problem, moved);
      };
      EXPECT_NEAR((cost(1e-5) - cost(-1e-5)) / 2e-5, 0.0, 1e-3) << i << " " << d;
      EXPECT_GT(cost(1e-4), minimum) << i << " " << d;
    }
  }
}

// A closure that measures a roll s against the keyframes, with information 1 and c between x and
// roll: x^2 - 2 c x s is least at x = c s; the odometry has a weight of 1e-6.
TEST(Gravity, CoupledInformationMovesTheOtherComponents) {
  Problem problem = along_x({0.0, 1.0});
  problem.odometry[0].information *= 1e-6;
  Edge closure = problem.odometry[0];
  closure.information = Matrix6::Identity();
  closure.information(0, 3) = closure.information(3, 0) = 0.5;
  closure.from_from_to.rotation = exp_so3({0.02, 0.0, 0.0});
  problem.closures = {closure};
  const Trajectory held = corrected<PoseGraphOptimizer>(problem, {.gravity = true});
  EXPECT_NEAR(held[1].world_from_body.translation.x(), 1.0 + 0.5 * 0.02 / (1.0 + 1e-6), 1e-10);
  EXPECT_NEAR(tilt_between(held[1].world_from_body, {}), 0.0, 1e-12);
}

TEST(Gravity, WorksWithRobustLossesAndIncompleteOdometry) {
  auto [truth, problem] = flight(7);
  problem.odometry.erase(problem.odometry.begin() + 60);  // a break; closures connect the rest
  for (const PoseGraphOptimizer::Options& options :
       {PoseGraphOptimizer::Options{.loss = RobustLoss::dcs, .gravity = true},
        PoseGraphOptimizer::Options{.loss = RobustLoss::huber, .gravity = true},
        PoseGraphOptimizer::Options{.gnc = Gnc::tls, .gravity = true}}) {
    const Trajectory held = corrected<PoseGraphOptimizer>(problem, options);
    EXPECT_LT(largest_tilt(held, problem.keyframes), 1e-9);
    EXPECT_LT(position_error(held, truth), position_error(problem.keyframes, truth));
  }
}

// Two anchors at different horizontal positions determine yaw and position.
TEST(Gravity, AnchorsMoveAndTurnTheFrameAboutTheVertical) {
  const Trajectory truth = hand_held_truth();
  const Pose elsewhere{exp_so3({0.0, 0.0, 2.0}), {30.0, -20.0, 10.0}};
  Problem problem = moved_by(elsewhere, perfect());
  const Vector3 lever(0.3, -0.1, 0.2);
  for (const std::size_t i : {5UL, 40UL}) {
    problem.anchors.push_back(
        {i, truth[i].world_from_body * lever, 1e-4 * Matrix3::Identity(), lever});
  }
  expect_close(corrected<PoseGraphOptimizer>(problem, {.gravity = true}), truth, 1e-7, 1e-7);
  problem.closures.clear();
  expect_close(corrected<PoseGraphOptimizer>(problem, {.gravity = true}), truth, 1e-7, 1e-7);
}

TEST(Gravity, CovariancesHaveNoRollAndPitch) {
  const auto [truth, problem] = flight(2);
  Report report;
  corrected<PoseGraphOptimizer>(problem, {.gravity = true, .covariances = true}, &report);
  ASSERT_EQ(report.covariances.size(), problem.keyframes.size());
  const Matrix6& last = report.covariances.back();
  EXPECT_GT(last(5, 5), 0.0);
  EXPECT_GT((last.topLeftCorner<3, 3>().determinant()), 0.0);
  EXPECT_NEAR((last.block<2, 6>(3, 0).norm()), 0.0, 1e-12);
}

TEST(Gravity, StatesThatClosuresContradictTheHeldTilt) {
  auto [truth, problem] = flight(4, 0.1);
  Report report;
  corrected<PoseGraphOptimizer>(problem, {.gravity = true}, &report);
  ASSERT_FALSE(report.notes.empty());
  EXPECT_NE(report.notes.front().find("differ from the held roll and pitch by"), std::string::npos)
      << report.notes.front();
}

TEST(Gravity, HasNoEffectInThePlane) {
  Report report;
  const Trajectory held = corrected<PoseGraphOptimizer>(planar(), {.gravity = true}, &report);
  expect_close(held, corrected<PoseGraphOptimizer>(planar()), 0.0, 0.0);
  ASSERT_FALSE(report.notes.empty());
  EXPECT_NE(report.notes.front().find("gravity has no effect"), std::string::npos);
}

TEST(Gravity, DeclinesEdgesThatChangeTheScale) {
  Problem problem = hand_held();
  problem.closures[0].scale = 1.1;
  EXPECT_NE(PoseGraphOptimizer({.gravity = true}).why_declined(problem).find("scale"),
            std::string::npos);
  EXPECT_NE(PoseGraphOptimizer({.group = PoseGraphOptimizer::Poses::sim3, .gravity = true})
                .why_declined(hand_held())
                .find("sim3"),
            std::string::npos);
}

}  // namespace
}  // namespace loopbench::test::gravity_test
