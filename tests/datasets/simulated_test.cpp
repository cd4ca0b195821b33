#include "datasets/simulated/simulated.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "datasets/core/polyline.hpp"
#include "tests/datasets/scratch.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::simulated_test {
namespace {

std::string refusal(const Params& given) {
  return refusal_of<OptionError>([&] { load_dataset("simulated", given); });
}

using loopbench::same_bits;  // of trajectories

bool same_bits(const std::vector<Edge>& a, const std::vector<Edge>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Edge& x, const Edge& y) {
    return x.from == y.from && x.to == y.to && x.information == y.information &&
           x.from_from_to.translation == y.from_from_to.translation &&
           x.from_from_to.rotation.coeffs() == y.from_from_to.rotation.coeffs();
  });
}

bool same_bits(const Sequence& a, const Sequence& b) {
  return same_bits(a.problem.keyframes, b.problem.keyframes) &&
         same_bits(a.problem.frames, b.problem.frames) &&
         same_bits(a.problem.odometry, b.problem.odometry) &&
         same_bits(a.problem.closures, b.problem.closures) && same_bits(a.reference, b.reference);
}

/// ATE (RMSE) of the keyframes after least-squares alignment [m].
double ate(const Sequence& sequence) {
  const Polyline reference(sequence.reference);
  const Trajectory& keyframes = sequence.problem.keyframes;
  const auto n = static_cast<Eigen::Index>(keyframes.size());
  Eigen::Matrix3Xd from(3, n), to(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& [stamp, pose] = keyframes[static_cast<std::size_t>(i)];
    from.col(i) = pose.translation;
    to.col(i) = reference.at(stamp).translation;
  }
  const Eigen::Matrix4d moved = Eigen::umeyama(from, to, false);
  const Eigen::Matrix3Xd error =
      ((moved.topLeftCorner<3, 3>() * from).colwise() + moved.topRightCorner<3, 1>()) - to;
  return std::sqrt(error.squaredNorm() / static_cast<double>(n));
}

double median_ate(SimulatedPath path) {
  std::vector<double> all;
  SimulatedOptions options;
  options.path = path;
  for (options.seed = 0; options.seed < 31; ++options.seed) {
    all.push_back(ate(load_simulated(options)));
  }
  std::nth_element(all.begin(), all.begin() + 15, all.end());
  return all[15];
}

TEST(Simulated, SameOptionsGiveTheSameBits) {
  SimulatedOptions options;
  options.closures.false_share = 0.3;
  for (const auto& [name, which] : choices(SimulatedPath{})) {
    options.path = which;
    options.closures.false_share = which == SimulatedPath::still ? 0.0 : 0.3;
    EXPECT_TRUE(same_bits(load_simulated(options), load_simulated(options))) << name;
  }
}

TEST(Simulated, SeedsDifferInNoiseAndAgreeInTruth) {
  SimulatedOptions options;
  const Sequence one = load_simulated(options);
  options.seed = 2;
  const Sequence two = load_simulated(options);
  options.seed = 1 + (std::int64_t{1} << 32);
  const Sequence far = load_simulated(options);
  EXPECT_TRUE(same_bits(one.reference, two.reference));
  EXPECT_FALSE(same_bits(one.problem.keyframes, two.problem.keyframes));
  EXPECT_FALSE(same_bits(one.problem.closures, two.problem.closures));
  EXPECT_FALSE(same_bits(one.problem.keyframes, far.problem.keyframes));
}

TEST(Simulated, WithoutErrorTheKeyframesAreTheReference) {
  for (const auto& [name, which] : choices(SimulatedPath{})) {
    SimulatedOptions options;
    options.path = which;
    options.noise.gain = 0.0;
    options.closures.sigma_t = 0.0;
    options.closures.sigma_r = 0.0;
    const Sequence sequence = load_simulated(options);
    EXPECT_NO_THROW(check(sequence.problem, name));
    const Polyline reference(sequence.reference);
    for (const Trajectory* poses : {&sequence.problem.keyframes, &sequence.problem.frames}) {
      for (const auto& [stamp, pose] : *poses) {
        ASSERT_POSE_NEAR(pose, reference.at(stamp), 1e-9, 1e-11) << name << " at " << stamp;
      }
    }
    for (const Edge& edge : sequence.problem.closures) {
      const Pose step = sequence.problem.keyframes[edge.from].world_from_body.inverse() *
                        sequence.problem.keyframes[edge.to].world_from_body;
      EXPECT_POSE_NEAR(step, edge.from_from_to, 1e-9, 1e-11) << name;
    }
  }
}

TEST(Simulated, EveryPathIsAValidProblem) {
  for (const auto& [name, which] : choices(SimulatedPath{})) {
    for (const bool planar : {false, true}) {
      SimulatedOptions options;
      options.path = which;
      options.planar = planar;
      const Sequence sequence = load_simulated(options);
      EXPECT_NO_THROW(check(sequence.problem, name));
      EXPECT_NO_THROW(check(sequence.reference, name));
      EXPECT_EQ(sequence.name, std::string("simulated_") + name);
      EXPECT_EQ(sequence.problem.odometry.size() + 1, sequence.problem.keyframes.size());
      EXPECT_EQ(sequence.problem.planar, planar);
      EXPECT_FALSE(sequence.provenance.oracle_closures);
      EXPECT_TRUE(sequence.provenance.inputs.empty());
    }
  }
}

TEST(Simulated, PlanarOnesStayInThePlaneToTheBit) {
  for (const SimulatedPath which : {SimulatedPath::room, SimulatedPath::driving}) {
    SimulatedOptions options;
    options.path = which;
    options.planar = true;
    const Sequence sequence = load_simulated(options);
    for (const Trajectory* poses :
         {&sequence.problem.keyframes, &sequence.problem.frames, &sequence.reference}) {
      for (const auto& [stamp, pose] : *poses) {
        ASSERT_EQ(pose.translation.z(), 0.0);
        ASSERT_EQ(pose.rotation.x(), 0.0);
        ASSERT_EQ(pose.rotation.y(), 0.0);
      }
    }
    for (const Edge& edge : sequence.problem.closures) {
      EXPECT_EQ(edge.from_from_to.translation.z(), 0.0);
      EXPECT_EQ(edge.from_from_to.rotation.x(), 0.0);
    }
    EXPECT_GT(ate(sequence), 0.01);
  }
}

TEST(Simulated, KeyframesAreFramesAndFramesHaveAReferencePoseEach) {
  const Sequence sequence = load_simulated({});
  const Trajectory& frames = sequence.problem.frames;
  EXPECT_EQ(frames.size(), 1468U);
  EXPECT_EQ(sequence.reference.size(), 4U * 1467U + 1U);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    ASSERT_EQ(frames[k].stamp, sequence.reference[4 * k].stamp);
  }
  std::size_t k = 0;
  for (const StampedPose& keyframe : sequence.problem.keyframes) {
    while (k < frames.size() && frames[k].stamp < keyframe.stamp) ++k;
    ASSERT_TRUE(same_bits({keyframe}, {frames[k]}));
  }
  EXPECT_EQ(sequence.problem.keyframes.front().stamp, frames.front().stamp);
  EXPECT_EQ(sequence.problem.keyframes.back().stamp, frames.back().stamp);
}

TEST(Simulated, LapsRepeatTheLoop) {
  SimulatedOptions options;
  options.laps = 3;
  const Sequence sequence = load_simulated(options);
  EXPECT_EQ(sequence.problem.keyframes.size(), 540U);
  EXPECT_NEAR(sequence.reference.back().stamp, 3 * 48.9, 0.01);
  EXPECT_NEAR(path_length(sequence.reference), 3 * 16.05, 0.2);
}

TEST(Simulated, TakesOneAndTwoKeyframes) {
  SimulatedOptions options;
  for (options.keyframes = 1; options.keyframes <= 2; ++options.keyframes) {
    const Problem problem = load_simulated(options).problem;
    EXPECT_EQ(problem.keyframes.size(), static_cast<std::size_t>(options.keyframes));
    EXPECT_NO_THROW(check(problem, "few"));
  }
}

TEST(Simulated, TakesAHundredThousandKeyframesOfOnePlace) {
  SimulatedOptions options;
  options.laps = 70;
  options.keyframes = 100000;
  options.reference_rate = 1.0;
  options.closures.max = 50000;
  const Problem problem =
      load_simulated(options).problem;  // takes seconds only if the cost is linear
  EXPECT_EQ(problem.keyframes.size(), 100000U);
  EXPECT_EQ(problem.closures.size(), 50000U);
}

TEST(Simulated, DefaultsDriftLikeOpenVisualOdometry) {
  EXPECT_NEAR(
      median_ate(SimulatedPath::room), 0.109, 0.02);  // ORB-SLAM2 without loop closing on fr1_room
  const double driving = median_ate(SimulatedPath::driving);
  EXPECT_GT(driving, 2.0);
  EXPECT_LT(driving, 8.0);
}

TEST(Simulated, OptionsAreRefusedByRule) {
  EXPECT_EQ(refusal({{"path", std::string("moon")}}),
            "path = moon: expected one of room | office | driving | line | still | spin");
  EXPECT_EQ(refusal({{"closures.false_share", 1.0}}),
            "closures.false_share = 1.0: expected 0 <= closures.false_share <= 0.95");
  EXPECT_EQ(refusal({{"closures.min_gap", 0.0}}),
            "closures.min_gap = 0.0: expected closures.min_gap > 0");
  EXPECT_EQ(refusal({{"keyframes", std::int64_t{5000}}}),
            "keyframes = 5000: expected keyframes <= 1468, the number of frames");
  EXPECT_EQ(refusal({{"laps", std::int64_t{1} << 40}}).substr(0, 6), "laps: ");
  EXPECT_EQ(refusal({{"planar", true}, {"drift.pitch_per_metre", 0.01}}),
            "drift.pitch_per_metre = 0.01: causes motion out of the plane, expected 0 with planar "
            "= true");
  EXPECT_EQ(refusal({{"planar", true}, {"drift.yaw_per_metre", 0.01}}), "");
  EXPECT_NE(refusal({{"closures.max", std::int64_t{0}}, {"closures.false_share", 0.5}})
                .find("expected 0 with closures.max = 0"),
            std::string::npos);
}

TEST(Simulated, ShakesEveryFrameAndNothingElse) {
  const Params still{{"path", std::string("room")}, {"stream", std::string("shared")}};
  Params with_white_noise = still;
  with_white_noise["white_noise.sigma_t"] = 0.02;
  with_white_noise["white_noise.sigma_r"] = 0.005;
  const Sequence before = load_dataset("simulated", still),
                 after = load_dataset("simulated", with_white_noise);
  EXPECT_TRUE(same_bits(before.problem.odometry, after.problem.odometry));
  EXPECT_TRUE(same_bits(before.problem.closures, after.problem.closures));
  EXPECT_TRUE(same_bits(before.reference, after.reference));
  const Trajectory& frames = before.problem.frames;
  double metres = 0.0, radians = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Twist moved =
        log_se3(frames[i].world_from_body.inverse() * after.problem.frames[i].world_from_body);
    metres += moved.head<3>().squaredNorm();
    radians += moved.tail<3>().squaredNorm();
  }
  const double draws = 3.0 * static_cast<double>(frames.size());
  EXPECT_NEAR(std::sqrt(metres / draws), 0.02, 1e-3);  // 4400 draws: 1 % each
  EXPECT_NEAR(std::sqrt(radians / draws), 0.005, 2.5e-4);
}

}  // namespace
}  // namespace loopbench::simulated_test
