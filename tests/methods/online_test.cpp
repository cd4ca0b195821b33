/// Replays of small problems, worked by hand.
#include "methods/online/online.hpp"

#include <gtest/gtest.h>

#include "datasets/core/polyline.hpp"
#include "datasets/core/replay.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "methods/correctors/uniform.hpp"
#include "methods/online/batch_updates.hpp"
#include "methods/online/replay_run.hpp"
#include "methods/pipeline.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::test::online_test {
namespace {

/// Keyframes at 0, 1, 2, 3, 4 m, a second apart; a closure measures 2 m between the first and the
/// fourth.
Problem shortened() {
  Problem out = test::along_x({0, 1, 2, 3, 4});
  out.closures.push_back({0, 3, at_x(2.0)});
  return out;
}

/// Positions along x [m].
std::vector<double> positions(const Trajectory& poses) {
  std::vector<double> out;
  for (const StampedPose& pose : poses) out.push_back(pose.world_from_body.translation.x());
  return out;
}

struct Replayed {
  std::unique_ptr<const Curve> curve;
  Report report;
  const Replay& record() const { return *curve->replay(); }
};

template <class Method>
Replayed replayed(const Problem& problem,
                  const Online::Options& options = {},
                  const typename Method::Options& of_method = {}) {
  Replayed out;
  const auto method =
      Online(options).replayed(compose(std::make_unique<Method>(of_method), nullptr));
  EXPECT_EQ(method->why_declined(problem), "");
  out.curve = method->estimate(problem, out.report);
  return out;
}

/// Keeps the tracker's poses, and records what arrives.
class Recorder final : public Incremental {
 public:
  Trajectory update(const Increment& added, Report&) override {
    increments.push_back(added);
    keyframes.insert(keyframes.end(), added.keyframes.begin(), added.keyframes.end());
    return keyframes;
  }
  std::vector<Increment> increments;
  Trajectory keyframes;
};

TEST(Online, RecordsTheCurrentPoseAndItsJump) {
  const Replayed out = replayed<Uniform>(shortened());
  // The gap of 1 m is distributed over three steps; the fifth keyframe is composed from the fourth.
  expect_positions(out.record().causal, {0, 1, 2, 2, 3});
  ASSERT_EQ(out.record().updates.size(), 2u);  // the closure, and the last keyframe
  const ReplayUpdate& closure = out.record().updates.front();
  EXPECT_EQ(closure.time, 3.0);
  EXPECT_EQ(closure.keyframes, 4u);
  EXPECT_EQ(closure.closures, 1u);
  EXPECT_NEAR(closure.before.translation.x(), 3.0, 1e-12);
  EXPECT_NEAR(closure.after.translation.x(), 2.0, 1e-12);
  EXPECT_EQ(out.record().updates.back().closures, 0u);
  EXPECT_EQ(out.record().updates.back().keyframes, 5u);
  EXPECT_EQ(test::count(out.report, "updates"), 2.0);
}

TEST(Online, ReturnsTheCausalTrajectoryOnRequest) {
  const Replayed out = replayed<Uniform>(shortened(), {.result = Online::Result::causal});
  expect_positions(out.curve->sample({0, 1, 2, 2.5, 3, 4}), {0, 1, 2, 2, 2, 3});
  expect_positions(out.record().causal, {0, 1, 2, 2, 3});
}

TEST(Online, DelaysClosures) {
  const Replayed out = replayed<Uniform>(shortened(), {.arrivals = {.delay = 0.5}});
  expect_positions(out.record().causal, {0, 1, 2, 3, 3});
  const Replayed late = replayed<Uniform>(shortened(), {.arrivals = {.delay = 60.0}});
  expect_positions(late.record().causal, {0, 1, 2, 3, 4});
  ASSERT_EQ(late.record().updates.size(), 1u);
  EXPECT_EQ(late.record().updates.front().time, 63.0);
  EXPECT_NEAR(late.curve->at(3.0).translation.x(), 2.0, 1e-12);
}

TEST(Online, PassesEverythingOnceAndInOrder) {
  const Problem problem = test::hand_held();
  Recorder recorder;
  Report report;
  ReplayRun run(problem, recorder, 1, report);
  run.run(closure_arrivals(problem, {}));
  ASSERT_EQ(recorder.increments.size(), 3u);
  EXPECT_EQ(recorder.increments[0].keyframes.size(), 41u);  // the first closure ends at keyframe 40
  EXPECT_EQ(recorder.increments[1].keyframes.size(), 17u);  // the second at keyframe 57
  EXPECT_EQ(recorder.increments[2].keyframes.size(), 2u);
  std::size_t odometry = 0, frames = 0;
  for (const Increment& each : recorder.increments) {
    odometry += each.odometry.size();
    frames += each.frames.size();
  }
  EXPECT_EQ(odometry, problem.odometry.size());
  EXPECT_EQ(frames, problem.frames.size());
  EXPECT_EQ(recorder.increments[1].closures.front().to, 57u);
}

TEST(Online, WaitsForSeveralClosures) {
  EXPECT_EQ(replayed<Dual>(test::hand_held()).record().updates.size(), 3u);
  EXPECT_EQ(replayed<Dual>(test::hand_held(), {.every = 2}).record().updates.size(), 2u);
  EXPECT_EQ(replayed<Dual>(test::hand_held(), {.max_updates = 1}).record().updates.size(), 2u);
}

TEST(Online, ArrivalsCanBeOutOfOrderAndRepeated) {
  const Problem problem = test::walk(3, 30, 0.01);
  const auto order = [&](const ArrivalOptions& options) {
    std::vector<std::size_t> out;
    for (const Arrival& each : closure_arrivals(problem, options)) out.push_back(each.closure.to);
    return out;
  };
  EXPECT_EQ(order({}), (std::vector<std::size_t>{15, 27, 29}));
  EXPECT_EQ(order({.jitter = 100.0, .seed = 2}).size(), 3u);
  bool is_reordered = false;
  for (std::int64_t seed = 1; seed < 10; ++seed) {
    is_reordered = is_reordered || order({.jitter = 100.0, .seed = seed}) != order({});
  }
  EXPECT_TRUE(is_reordered);
  EXPECT_EQ(order({.repeated = 1.0}), (std::vector<std::size_t>{15, 15, 27, 27, 29, 29}));
}

TEST(Online, EndsWithTheResultOfTheProblemInAnyOrder) {
  const Problem problem = test::walk(4, 40, 0.02);
  const Replayed out = replayed<Dual>(
      problem, {.arrivals = {.jitter = 50.0, .false_closures = 3, .withdrawn_after = 5.0}});
  EXPECT_GE(out.record().updates.size(), 2u);
  test::expect_close(
      out.curve->sample(stamps(problem.keyframes)), test::corrected<Dual>(problem), 1e-12);
}

TEST(Online, FalseClosuresAreWithdrawnAndDamageOnlyUntilThen) {
  const Problem problem = shortened();
  const ArrivalOptions options{.false_closures = 1, .withdrawn_after = 1.5, .seed = 2};
  const std::vector<Arrival> arrivals = closure_arrivals(problem, options);
  ASSERT_EQ(arrivals.size(), 3u);
  const auto withdrawn = std::ranges::find(arrivals, true, &Arrival::is_withdrawn);
  ASSERT_NE(withdrawn, arrivals.end());
  EXPECT_LT(withdrawn->closure.from, withdrawn->closure.to);
  const Replayed out = replayed<Uniform>(problem, {.arrivals = options});
  expect_positions(out.curve->sample(stamps(problem.keyframes)),
                   positions(test::corrected<Uniform>(problem)));
  // It closes the complete path by half of its length, and is withdrawn after the end.
  EXPECT_EQ(withdrawn->closure.to, 4u);
  EXPECT_EQ(withdrawn->time, 5.5);
  EXPECT_LT(out.record().causal.back().world_from_body.translation.x(), 2.5);
  const Replayed stays = replayed<Uniform>(
      problem, {.arrivals = {.false_closures = 1, .withdrawn_after = std::nullopt, .seed = 2}});
  EXPECT_NE(positions(stays.curve->sample(stamps(problem.keyframes))),
            positions(test::corrected<Uniform>(problem)));
}

TEST(Online, TheOnlyClosureIsWithdrawnWithWhatItMoved) {
  const Problem problem = shortened();
  const auto method = compose(std::make_unique<Dual>(Dual::Options{}), nullptr);
  for (const bool is_warm : {false, true}) {
    BatchUpdates updates(*method, problem.planar, is_warm);
    Report report;
    Increment all{.keyframes = problem.keyframes, .odometry = problem.odometry};
    all.closures = problem.closures;
    EXPECT_LT(positions(updates.update(all, report)).back(), 3.5);
    expect_positions(updates.update({.withdrawn = problem.closures}, report), {0, 1, 2, 3, 4});
  }
}

TEST(Online, ExtendsSim3ChainsInTheScaleOfTheSolution) {
  // The measured scale doubles at each keyframe: steps of 1 m are measured as 1, 0.5, 0.25 m.
  Problem problem = test::along_x({0, 1, 1.5, 1.75});
  for (Edge& edge : problem.odometry) edge.scale = 2.0;
  ExtendedChain chain(problem);
  chain.extend(2);
  expect_positions(chain.poses(), {0, 1});
  chain.replace(chain.poses());
  chain.extend(4);
  expect_positions(chain.poses(), {0, 1, 2, 3});
}

TEST(Online, BridgesMissingOdometryByTheTrackersMotion) {
  Problem problem = shortened();
  problem.odometry.erase(problem.odometry.begin() + 3);
  expect_positions(replayed<Dual>(shortened()).record().causal, {0, 1, 2, 2.25, 3.25});
  ExtendedChain chain(problem);
  chain.extend(5);
  expect_positions(chain.poses(), {0, 1, 2, 3, 4});
}

TEST(Online, WarmStartsReachTheSameMinimum) {
  const Problem problem = test::walk(5, 60, 0.02);
  const PoseGraphOptimizer::Options options{.start = PoseGraphOptimizer::Start::keyframes};
  const Replayed cold = replayed<PoseGraphOptimizer>(problem, {}, options);
  const Replayed warm = replayed<PoseGraphOptimizer>(problem, {.warm = true}, options);
  const std::vector<double> times = stamps(problem.keyframes);
  test::expect_close(warm.curve->sample(times), cold.curve->sample(times), 1e-6);
  EXPECT_LE(test::count(warm.report, "iterations"), test::count(cold.report, "iterations"));
}

TEST(Online, ExtendsByOdometryWhereTheMethodDeclines) {
  const Problem problem = test::hand_held();
  // Twice the closures exceed the limit; the last update is declined.
  const Online::Options options{.arrivals = {.repeated = 1.0}};
  const Replayed out = replayed<Dual>(problem, options, {.max_closures = 2});
  EXPECT_EQ(test::count(out.report, "updates_declined"), 2.0);
  EXPECT_EQ(out.record().causal.size(), problem.keyframes.size());
}

/// As a program, which declines while it runs.
struct NeedsClosures final : Corrector {
  struct Options {
    std::size_t fewest = 2;
  };
  explicit NeedsClosures(const Options& given) : options(given) {}
  Trajectory correct(const Problem& problem, Report&) const override {
    if (problem.closures.size() < options.fewest) throw Declined("needs more closures");
    return problem.keyframes;
  }
  Options options;
};

TEST(Online, ExtendsByOdometryWhereAProgramDeclines) {
  Problem problem = shortened();
  problem.closures.push_back({0, 4, at_x(2.5)});
  EXPECT_EQ(test::count(replayed<NeedsClosures>(problem).report, "updates_declined"), 1.0);
  EXPECT_THROW(replayed<NeedsClosures>(problem, {}, {.fewest = 3}), Declined);
}

TEST(Online, KeepsTheTimeOfTheMethodAndSumsPhases) {
  const Replayed out = replayed<PoseGraphOptimizer>(test::hand_held());
  std::size_t solves = 0;
  for (const Phase& phase : out.report.phases) solves += phase.name == "solve" ? 1 : 0;
  EXPECT_EQ(solves, 1u);
  for (const ReplayUpdate& update : out.record().updates) EXPECT_GT(update.seconds, 0.0);
}

}  // namespace
}  // namespace loopbench::test::online_test
