/// Metrics of a replay, worked by hand.
#include <cmath>

#include "evaluated_cell.hpp"
#include "metrics/metric.hpp"
#include "metrics/online/replayed.hpp"
#include "replayed_polyline.hpp"
#include "support.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::test::online_metrics_test {
namespace {

Trajectory poses_along_x(const std::vector<double>& positions) {
  return test::along_x(positions).keyframes;
}

/// Reference at 0, 1, 2, 3, 4 m, estimate equal to it at the end. The robot was at 0, 1.5, 2, 3.5,
/// 4 m when it was there; closures moved it at keyframes 2 (from 2.5 to 2 m) and 4 (from 5 to 4 m).
EvaluatedCell drive(const Protocol& protocol = {.align = Align::none}) {
  const Replay replay{poses_along_x({0.0, 1.5, 2.0, 3.5, 4.0}),
                      {test::closure_at(2, 2.5, 2.0), test::closure_at(4, 5.0, 4.0)}};
  return {poses_along_x({0, 1, 2, 3, 4}),
          test::along_x({0, 1, 2, 3, 4}),
          std::make_unique<test::ReplayedPolyline>(poses_along_x({0, 1, 2, 3, 4}), replay),
          Times::keyframes,
          protocol};
}

TEST(Causal, ErrorsAreThoseOfEachPoseAtItsOwnTime) {
  const EvaluatedCell cell = drive();
  const Statistics ate = find(causal_ate(cell.evaluation), "translation", "3d");
  EXPECT_EQ(ate.count, 5u);
  EXPECT_DOUBLE_EQ(ate.mean, 0.2);  // 0, 0.5, 0, 0.5, 0
  EXPECT_DOUBLE_EQ(ate.max, 0.5);
  const Statistics rpe = find(causal_rpe(cell.evaluation, {.min_pairs = 1.0}), "translation", "3d");
  EXPECT_EQ(rpe.count, 4u);
  EXPECT_DOUBLE_EQ(rpe.rmse, 0.5);  // steps of 1.5, 0.5, 1.5, 0.5 m instead of 1 m
}

TEST(Causal, IsAlignedByTheProtocol) {
  const EvaluatedCell cell = drive({.align = Align::origin});
  // The first poses are equal.
  EXPECT_DOUBLE_EQ(find(causal_ate(cell.evaluation), "translation", "3d").mean, 0.2);
}

TEST(ClosureJumps, AreDistancesBetweenBeforeAndAfter) {
  const std::vector<Score> scores = closure_jumps(drive().evaluation);
  const Statistics jumps = find(scores, "translation", "3d");
  EXPECT_EQ(jumps.count, 2u);
  EXPECT_DOUBLE_EQ(jumps.max, 1.0);
  EXPECT_DOUBLE_EQ(jumps.rmse, std::sqrt(0.5 * (0.25 + 1.0)));
  EXPECT_DOUBLE_EQ(find(scores, "rotation", "3d").max, 0.0);
}

TEST(UpdateTime, HasPercentilesMissesAndGrowth) {
  Replay replay;  // ten updates of n^2 microseconds
  for (std::size_t n = 10; n <= 100; n += 10) {
    ReplayUpdate update;
    update.keyframes = n;
    update.seconds = 1e-6 * static_cast<double>(n * n);
    replay.updates.push_back(update);
  }
  const test::ReplayedPolyline curve(poses_along_x({0, 1}), replay);
  Evaluation evaluation;
  evaluation.context.curve = &curve;
  const std::vector<Score> scores = update_time(evaluation, {.rate = 200.0});
  EXPECT_DOUBLE_EQ(find(scores, "percentile", "median").mean, 1e-6 * 0.5 * (2500 + 3600));
  EXPECT_DOUBLE_EQ(find(scores, "percentile", "p95").mean, 1e-6 * (0.45 * 8100 + 0.55 * 10000));
  EXPECT_DOUBLE_EQ(find(scores, "percentile", "max").mean, 0.01);
  EXPECT_DOUBLE_EQ(find(scores, "misses", "").mean, 30.0);  // 6.4, 8.1 and 10 ms exceed 5 ms
  EXPECT_NEAR(find(scores, "growth", "").mean, 2.0, 1e-12);
}

TEST(UpdateTime, HasNoGrowthOverAFewKeyframes) {
  for (const Score& score : update_time(drive().evaluation, {})) {
    EXPECT_EQ(score.why_undefined.empty(), score.relation != "growth") << score.relation;
  }
}

TEST(Online, IsUndefinedForMethodsThatWereNotReplayed) {
  const EvaluatedCell cell(poses_along_x({0, 1, 2}),
                           test::along_x({0, 1, 2}),
                           poses_along_x({0, 1, 2}),
                           {.align = Align::none});
  for (const MetricEntry& metric : metrics::metrics()) {
    if (metric.summary.find("replay") == std::string::npos) continue;
    EXPECT_EQ(test::why<Undefined>([&] { metric.score(cell.evaluation, {}); }),
              "the method was not replayed; put `online +` in front of it")
        << metric.name;
  }
}

TEST(Online, IsUndefinedWithoutClosures) {
  const Replay replay{poses_along_x({0, 1, 2}), {}};
  const EvaluatedCell cell(
      poses_along_x({0, 1, 2}),
      test::along_x({0, 1, 2}),
      std::make_unique<test::ReplayedPolyline>(poses_along_x({0, 1, 2}), replay),
      Times::keyframes,
      {.align = Align::none});
  EXPECT_THROW(closure_jumps(cell.evaluation), Undefined);
  EXPECT_THROW(update_time(cell.evaluation, {}), Undefined);
  EXPECT_EQ(find(causal_ate(cell.evaluation), "translation", "3d").max, 0.0);
}

}  // namespace
}  // namespace loopbench::test::online_metrics_test
