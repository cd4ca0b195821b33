#include "datasets/noise/noise_stream.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

#include "datasets/simulated/simulated.hpp"
#include "datasets/trajectory_dataset.hpp"
#include "tests/datasets/random_poses.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::noise_stream_test {
namespace {

SimulatedOptions small(const std::function<void(SimulatedOptions&)>& change) {
  SimulatedOptions options;
  options.keyframes = 20;
  change(options);
  return options;
}

/// Errors of all odometry edges with respect to the ground truth, concatenated.
std::vector<double> odometry_errors(const SimulatedOptions& options) {
  const Sequence sequence = load_simulated(options);
  std::vector<double> out;
  const auto truth_at = [&](std::size_t keyframe) {
    const double stamp = sequence.problem.keyframes[keyframe].stamp;
    for (const StampedPose& pose : sequence.reference) {
      if (pose.stamp == stamp) return pose.world_from_body;
    }
    throw std::logic_error("no reference pose at a keyframe");
  };
  for (const Edge& edge : sequence.problem.odometry) {
    const Pose step = truth_at(edge.from).inverse() * truth_at(edge.to);
    for (const double x : log_se3(step.inverse() * edge.from_from_to)) out.push_back(x);
  }
  return out;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    aa += a[i] * a[i];
    bb += b[i] * b[i];
    ab += a[i] * b[i];
  }
  return ab / std::sqrt(aa * bb);
}

/// Correlation of the errors of two datasets over ten seeds; standard error 0.03 if independent.
double correlation(SimulatedOptions a, SimulatedOptions b) {
  std::vector<double> of_a, of_b;
  for (std::int64_t seed = 1; seed <= 10; ++seed) {
    a.seed = b.seed = seed;
    for (const double x : odometry_errors(a)) of_a.push_back(x);
    for (const double x : odometry_errors(b)) of_b.push_back(x);
  }
  return correlation(of_a, of_b);
}

TEST(NoiseStream, DatasetsThatDifferInAnyOptionDrawIndependentNoise) {
  const SimulatedOptions room = small([](SimulatedOptions&) {});
  EXPECT_NEAR(correlation(room, room), 1.0, 1e-9);
  const auto with = [&](const std::function<void(SimulatedOptions&)>& change) {
    return correlation(room, small(change));
  };
  EXPECT_LT(std::abs(with([](auto& o) { o.path = SimulatedPath::office; })), 0.12);
  EXPECT_LT(std::abs(with([](auto& o) { o.noise.gain = 2.0; })), 0.12);
  EXPECT_LT(std::abs(with([](auto& o) { o.closures.max = 3; })), 0.12);
  EXPECT_LT(std::abs(with([](auto& o) { o.stream = "x"; })), 0.12);
}

TEST(NoiseStream, DatasetsOfOneNamedStreamShareTheirNoise) {
  const SimulatedOptions one = small([](auto& o) { o.stream = "x"; });
  const SimulatedOptions louder = small([](auto& o) {
    o.stream = "x";
    o.noise.gain = 2.0;
  });
  EXPECT_GT(correlation(one, louder), 0.99);
  const SimulatedOptions other = small([](auto& o) { o.stream = "y"; });
  EXPECT_LT(std::abs(correlation(one, other)), 0.12);
  EXPECT_EQ(load_simulated(one).provenance.noise, load_simulated(louder).provenance.noise);
  EXPECT_NE(load_simulated(one).provenance.noise, load_simulated(other).provenance.noise);
}

TEST(NoiseStream, IdentityLeavesOutSeedsAndDefaults) {
  SimulatedOptions options;
  const auto text = [&] {
    return identity_text("simulated", options, [](const std::string&) { return false; });
  };
  EXPECT_EQ(text(), "simulated: ");
  options.seed = 9;
  options.noise.gain = 1.0;
  EXPECT_EQ(text(), "simulated: ");
  options.noise.gain = 2.0;
  EXPECT_EQ(text(), "simulated: noise.gain=2.0");
  options.white_noise.sigma_t = 0.5;  // under its first name
  EXPECT_EQ(text(), "simulated: noise.gain=2.0, shake.sigma_t=0.5");
}

TEST(NoiseStream, ClosuresOfTwoChainsDrawIndependentNoise) {
  const auto errors = [](std::uint64_t walk, const std::string& stream, double sigma_t) {
    const Trajectory poses = random_walk(400, walk, 0.02, 0.02, 0.1);
    TrajectoryOptions options;
    options.closures = ClosureSource::reference;
    options.closures_radius = 10.0;
    options.closures_angle = 180.0;
    options.closures_max = 0;
    options.closures_noise = {sigma_t, sigma_t};
    options.stream = stream;
    options.name = "name " + stream;  // free text does not affect the noise
    std::vector<double> out;
    for (const Edge& edge : derive_problem({poses, {}, poses, {}, {}}, options).closures) {
      const Pose exact =
          poses[edge.from].world_from_body.inverse() * poses[edge.to].world_from_body;
      for (const double x : log_se3(exact.inverse() * edge.from_from_to)) out.push_back(x);
    }
    out.resize(600);
    return out;
  };
  const std::vector<double> first = errors(1, "", 0.01);
  EXPECT_EQ(first, errors(1, "", 0.01));
  EXPECT_LT(std::abs(correlation(first, errors(2, "", 0.01))), 0.15);
  EXPECT_LT(std::abs(correlation(first, errors(1, "", 0.02))), 0.15);
  EXPECT_GT(correlation(errors(1, "x", 0.01), errors(2, "x", 0.02)), 0.99);
}

TEST(NoiseStream, AMovedFolderDrawsTheSameNoise) {
  const auto closures = [](const TemporaryFolder& folder) {
    std::string text;
    for (int i = 0; i <= 20; ++i) {
      text += std::to_string(i) + " " + std::to_string(std::abs(10 - i)) + " 0 0 0 0 0 1\n";
    }
    folder.file("est.txt", text);
    const std::string file = (folder.path() / "est.txt").string();
    const Params given{{"estimate", file}, {"reference", file}, {"closures.source", "reference"}};
    return load_dataset("trajectory", given).problem.closures;
  };
  const TemporaryFolder first, second;
  const std::vector<Edge> a = closures(first), b = closures(second);
  ASSERT_FALSE(a.empty());
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a[0].from_from_to.translation, b[0].from_from_to.translation);
}

}  // namespace
}  // namespace loopbench::noise_stream_test
