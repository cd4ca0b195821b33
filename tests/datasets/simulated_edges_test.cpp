/// Errors of simulated odometry and closures, and the information that states them.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <numbers>

#include "datasets/simulated/edges.hpp"
#include "datasets/simulated/path.hpp"
#include "datasets/simulated/simulated.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::simulated_edges_test {
namespace {

SimulatedOptions quiet(SimulatedPath path) {
  SimulatedOptions out;
  out.path = path;
  out.noise.translation = {0.0, 0.0, 0.0, 0.0};
  out.noise.rotation = {0.0, 0.0, 0.0, 0.0};
  out.reference_rate = 1.0;
  return out;
}

/// Stated covariance of the first edge.
Matrix6 covariance(const SimulatedOptions& options) {
  return load_simulated(options).problem.odometry.front().information.inverse();
}

Pose last(const SimulatedOptions& options) {
  return load_simulated(options).problem.keyframes.back().world_from_body;
}

Twist error_of(const Edge& edge, const Problem& problem, const Path& path) {
  const Pose a = path.at(problem.keyframes[edge.from].stamp);
  const Pose b = path.at(problem.keyframes[edge.to].stamp);
  return log_se3(edge.from_from_to.inverse() * (a.inverse() * b));
}

/// Errors of all edges over many seeds, whitened by their stated information.
struct Whitened {
  double edges = 0.0;
  double chi_square = 0.0;  // mean over edges
  Twist mean = Twist::Zero();
  Matrix6 square = Matrix6::Zero();  // mean of e e^T

  Whitened(SimulatedOptions options,
           int seeds,
           std::vector<Edge> Problem::*of = &Problem::odometry) {
    const Path path = path_of(options.path);
    options.reference_rate = 1.0;
    for (options.seed = 0; options.seed < seeds; ++options.seed) {
      const Problem problem = load_simulated(options).problem;
      for (const Edge& edge : problem.*of) {
        const Twist white = edge.information.llt().matrixU() * error_of(edge, problem, path);
        edges += 1.0;
        chi_square += white.squaredNorm();
        mean += white;
        square += white * white.transpose();
      }
    }
    chi_square /= edges;
    mean /= edges;
    square /= edges;
  }
};

// The mean of n chi^2 variables of 6 degrees has standard deviation sqrt(12 / n); the bounds below
// are about four standard deviations.
TEST(SimulatedOdometry, ErrorsAreAsLargeAsTheInformationSays) {
  SimulatedOptions options;
  const Whitened room(options, 40);  // 7160 edges
  EXPECT_NEAR(room.chi_square, 6.0, 0.16);
  options.path = SimulatedPath::driving;
  const Whitened driving(options, 20);  // 7980 edges
  EXPECT_NEAR(driving.chi_square, 6.0, 0.16);
}

TEST(SimulatedOdometry, InformationOfLongEdgesKnowsTheLeverArms) {
  SimulatedOptions options;
  options.path = SimulatedPath::driving;
  options.keyframes = 21;                // 97 steps per edge, including corners
  const Whitened driving(options, 300);  // 6000 edges
  EXPECT_NEAR(driving.chi_square, 6.0, 0.18);
  EXPECT_LE(driving.mean.cwiseAbs().maxCoeff(), 4.0 / std::sqrt(driving.edges) + 0.01);
  EXPECT_LE((driving.square - Matrix6::Identity()).cwiseAbs().maxCoeff(), 0.08);
}

TEST(SimulatedOdometry, NoiseOfEverySourceIsAsLargeAsTheInformationSays) {
  SimulatedOptions options;
  options.noise.translation = {1e-5, 1e-4, 2e-5, 3e-4};
  options.noise.rotation = {1e-6, 2e-6, 1e-5, 4e-5};
  EXPECT_NEAR(Whitened(options, 40).chi_square, 6.0, 0.16);
}

// `line`: 0.5 m/s, five steps of 0.1 s per edge; `spin` with 41 keyframes: 2 pi / 40 per edge.
TEST(SimulatedOdometry, VarianceGrowsWithTime) {
  SimulatedOptions options = quiet(SimulatedPath::line);
  options.noise.translation.per_second = 1e-4;
  EXPECT_NEAR(covariance(options)(0, 0), 0.5e-4, 1e-10);
  options.noise.gain = 2.0;
  EXPECT_NEAR(covariance(options)(2, 2), 2e-4, 1e-10);
}

TEST(SimulatedOdometry, VarianceGrowsWithDistance) {
  SimulatedOptions options = quiet(SimulatedPath::line);
  options.noise.translation.per_metre = 1e-4;
  EXPECT_NEAR(covariance(options)(1, 1), 0.25e-4, 1e-10);
}

TEST(SimulatedOdometry, VarianceGrowsWithTurning) {
  SimulatedOptions options = quiet(SimulatedPath::spin);
  options.keyframes = 41;
  options.noise.rotation.per_radian = 1e-4;
  EXPECT_NEAR(covariance(options)(5, 5), 1e-4 * std::numbers::pi / 20.0, 1e-10);
  options.path = SimulatedPath::line;
  options.keyframes = 0;
  EXPECT_NEAR(covariance(options)(5, 5), 0.0, 1e-10);
}

TEST(SimulatedOdometry, VarianceGrowsWithSquaredSpeed) {
  SimulatedOptions options = quiet(SimulatedPath::line);
  options.noise.rotation.per_speed = 1e-4;
  EXPECT_NEAR(covariance(options)(3, 3), 1e-4 * 0.25 * 0.5, 1e-10);
}

TEST(SimulatedOdometry, LevelErrorsKeepRollAndPitch) {
  SimulatedOptions options;
  options.noise.level = true;
  options.drift.yaw_per_second = 0.01;
  options.drift.pitch_per_metre = 0.02;
  const Sequence sequence = load_simulated(options, DataRoot{});
  const Trajectory& frames = sequence.problem.frames;
  double largest_turn = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Rotation& truth = sequence.reference[4 * i].world_from_body.rotation;
    const Rotation error = frames[i].world_from_body.rotation * truth.conjugate();
    EXPECT_NEAR((error * Vector3::UnitZ() - Vector3::UnitZ()).norm(), 0.0, 1e-9) << i;
    largest_turn = std::max(largest_turn, log_so3(error).norm());
  }
  EXPECT_GT(largest_turn, 0.05);
}

TEST(SimulatedOdometry, TurningErrorsMoveTheEndOfTheEdge) {
  SimulatedOptions options = quiet(SimulatedPath::line);
  options.noise.rotation.per_second = 1e-2;  // 1e-3 rad^2 per step
  const Matrix6 S = covariance(options);
  // Five steps of 0.05 m: the lever arms of their errors are 0.20, 0.15, 0.10, 0.05 and 0 m.
  EXPECT_NEAR(S(1, 1), 1e-3 * 0.075, 1e-9);
  EXPECT_NEAR(S(1, 5), 1e-3 * 0.5, 1e-9);
  EXPECT_NEAR(S(2, 4), -1e-3 * 0.5, 1e-9);
  EXPECT_NEAR(S(0, 0), 0.0, 1e-9);
}

TEST(SimulatedOdometry, SystematicDriftIsWhatItsNameSays) {
  SimulatedOptions line = quiet(SimulatedPath::line);
  line.drift.scale = 0.01;
  EXPECT_NEAR((last(line).translation - Vector3(30.3, 0.0, 0.0)).norm(), 0.0, 1e-6);
  line.drift = {};
  line.drift.yaw_per_metre = 0.01;
  EXPECT_NEAR((log_so3(last(line).rotation) - Vector3(0.0, 0.0, 0.3)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(last(line).translation.y(), (1.0 - std::cos(0.3)) / 0.01, 0.02) << "to the left";
  line.drift = {};
  line.drift.pitch_per_metre = -0.01;
  EXPECT_NEAR(last(line).translation.z(), (1.0 - std::cos(0.3)) / 0.01, 0.02) << "nose up";

  SimulatedOptions still = quiet(SimulatedPath::still);
  still.drift.yaw_per_second = 0.01;
  EXPECT_NEAR((log_so3(last(still).rotation) - Vector3(0.0, 0.0, 0.3)).norm(), 0.0, 1e-9);
  still.drift = {};
  still.drift.pitch_per_second = 0.01;
  EXPECT_NEAR((log_so3(last(still).rotation) - Vector3(0.0, 0.3, 0.0)).norm(), 0.0, 1e-9);

  SimulatedOptions spin = quiet(SimulatedPath::spin);
  spin.drift.yaw_per_radian = 0.01;
  EXPECT_NEAR(log_so3(last(spin).rotation).z(), 0.02 * std::numbers::pi, 1e-9);
}

TEST(SimulatedOdometry, EdgesAreTheKeyframesOwnSteps) {
  const Problem problem = load_simulated({}).problem;
  for (const Edge& edge : problem.odometry) {
    const Pose step = problem.keyframes[edge.from].world_from_body.inverse() *
                      problem.keyframes[edge.to].world_from_body;
    EXPECT_POSE_NEAR(step, edge.from_from_to, 1e-12, 1e-12);
  }
}

TEST(SimulatedClosures, JoinSeparateVisitsOfOnePlace) {
  for (const SimulatedPath which :
       {SimulatedPath::room, SimulatedPath::office, SimulatedPath::driving}) {
    SimulatedOptions options;
    options.path = which;
    const Problem problem = load_simulated(options).problem;
    const Path path = path_of(which);
    EXPECT_GE(problem.closures.size(), 2U) << to_text(which);
    EXPECT_LE(problem.closures.size(), 10U);
    EXPECT_GT(problem.closures.back().to, problem.keyframes.size() - 3) << "the lap closes";
    for (const Edge& edge : problem.closures) {
      const double begin = problem.keyframes[edge.from].stamp;
      const double end = problem.keyframes[edge.to].stamp;
      EXPECT_GE(end - begin, 10.0);
      EXPECT_POSE_NEAR(path.at(begin), path.at(end), path.closure_radius, std::numbers::pi / 6.0);
    }
  }
}

TEST(SimulatedClosures, AreSpreadOverAllRevisits) {
  SimulatedOptions options;
  options.path = SimulatedPath::driving;
  options.closures.max = 1000;
  const Problem all = load_simulated(options).problem;
  options.closures.max = 4;
  const Problem few = load_simulated(options).problem;
  ASSERT_EQ(few.closures.size(), 4U);
  EXPECT_GT(all.closures.size(), 40U);
  EXPECT_EQ(few.closures.back().to, all.closures.back().to);
  EXPECT_EQ(few.closures.front().to, all.closures[all.closures.size() / 4 - 1].to);
  options.closures.max = 0;
  const Sequence none = load_simulated(options);
  EXPECT_TRUE(none.problem.closures.empty());
  EXPECT_EQ(none.provenance.closures, "none");
}

TEST(SimulatedClosures, ErrorsAreAsLargeAsTheInformationSays) {
  SimulatedOptions options;
  options.path = SimulatedPath::driving;
  options.closures.max = 100;
  options.closures.sigma_t = 0.3;
  options.closures.sigma_r = 0.01;
  const Whitened driving(options, 120, &Problem::closures);
  EXPECT_NEAR(driving.chi_square, 6.0, 4.0 * std::sqrt(12.0 / driving.edges));
  EXPECT_GT(driving.edges, 4000.0);
}

TEST(SimulatedClosures, FalseOnesAreCountedAndGrosslyWrong) {
  SimulatedOptions options;
  options.path = SimulatedPath::driving;
  options.closures.false_share = 0.5;
  const Sequence sequence = load_simulated(options);
  const Problem& problem = sequence.problem;
  EXPECT_EQ(problem.closures.size(), 20U);
  const Path path = path_of(options.path);
  std::vector<std::size_t> wrong;
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    const Edge& edge = problem.closures[k];
    const Twist e = error_of(edge, problem, path);
    if (e.dot(edge.information * e) > 60.0) wrong.push_back(k);
  }
  EXPECT_EQ(wrong.size(), 10U);
  EXPECT_EQ(sequence.false_closures, wrong);
  options.closures.false_share = 0.2;  // 10 true and 2.5 false closures, rounded to 12 or 13
  const std::size_t some = load_simulated(options).problem.closures.size();
  EXPECT_EQ(some, 13U);
}

TEST(SimulatedClosures, FalseOnesLeaveTheTrueOnesAsTheyWereInOneStream) {
  SimulatedOptions options;
  options.stream = "shared";  // otherwise the noise would depend on the share
  const Problem before = load_simulated(options).problem;
  options.closures.false_share = 0.5;
  const Problem after = load_simulated(options).problem;
  for (const Edge& edge : before.closures) {
    EXPECT_TRUE(std::any_of(after.closures.begin(), after.closures.end(), [&](const Edge& other) {
      return other.from == edge.from && other.to == edge.to &&
             other.from_from_to.translation == edge.from_from_to.translation;
    }));
  }
  EXPECT_EQ(before.keyframes.back().world_from_body.translation,
            after.keyframes.back().world_from_body.translation);
}

TEST(SimulatedClosures, FalseOnesAreRefusedWhereEveryPlaceIsTheSame) {
  SimulatedOptions options;
  options.path = SimulatedPath::still;
  options.closures.false_share = 0.5;
  try {
    load_simulated(options);
    FAIL();
  } catch (const OptionError& error) {
    EXPECT_EQ(error.option(), "closures.false_share");
  }
}

}  // namespace
}  // namespace loopbench::simulated_edges_test
