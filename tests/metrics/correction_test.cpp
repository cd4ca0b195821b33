/// Metrics of a correction: closures, and jumps and jerk of the curve.
#include <cmath>
#include <functional>
#include <numbers>

#include "evaluated_cell.hpp"
#include "metrics/correction/closure_prediction.hpp"
#include "metrics/correction/graph_cost.hpp"
#include "metrics/correction/smoothness.hpp"
#include "support.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::correction_test {

using namespace metrics;

namespace {

using test::EvaluatedCell;
using test::find;
using test::why;

const Protocol kAsIs{.align = Align::none};

/// Odometry of 60 steps of 1 m that are 1.01 m in truth; closures at three places state the truth.
Problem stretched() {
  std::vector<double> positions;
  for (int i = 0; i <= 60; ++i) positions.push_back(i);
  Problem out = test::along_x(positions);
  for (const std::size_t from : {0UL, 1UL, 25UL, 50UL}) {
    const double length = 1.01 * static_cast<double>(60 - from);
    out.closures.push_back({from, 60, test::at_x(length)});
  }
  return out;
}

/// Evaluates the metric for a method that moves the last keyframe by the mean of the gaps times
/// `share`, and counts its runs.
Score predicted(const Problem& problem, double share, int& runs, std::int64_t max_places = 20) {
  const SolveWithout solve = [&](const std::vector<std::size_t>& closures) {
    ++runs;
    Trajectory out = problem.keyframes;
    double sum = 0.0;
    for (std::size_t k = 0; k < problem.closures.size(); ++k) {
      const Edge& edge = problem.closures[k];
      const double length = static_cast<double>(edge.to - edge.from);
      if (std::ranges::count(closures, k) == 0) sum += edge.from_from_to.translation.x() - length;
    }
    const auto kept = static_cast<double>(problem.closures.size() - closures.size());
    out.back().world_from_body.translation.x() += share * sum / kept;
    return out;
  };
  Evaluation evaluation;
  evaluation.context.problem = &problem;
  evaluation.context.solve_without = &solve;
  return closure_prediction(evaluation, {max_places}).at(0);
}

TEST(ClosurePrediction, IsTheGeometricMeanOverPlacesWorkedByHand) {
  // Gaps of 0.6 and 0.59 m (one place), 0.35 and 0.1 m.
  const Problem problem = stretched();
  int runs = 0;
  const double first = std::hypot(0.6 - 0.225, 0.59 - 0.225) / std::hypot(0.6, 0.59);
  const double second = std::abs(0.35 - 1.29 / 3.0) / 0.35;
  const double third = std::abs(0.1 - 1.54 / 3.0) / 0.1;
  const Score score = predicted(problem, 1.0, runs);
  EXPECT_NEAR(score.statistics.rmse, std::cbrt(first * second * third), 1e-9);
  EXPECT_EQ(score.statistics.count, 3u);
  EXPECT_EQ(runs, 3);
  EXPECT_EQ(predicted(problem, 0.0, runs).statistics.rmse, 1.0);  // the odometry itself
  runs = 0;
  EXPECT_NEAR(predicted(problem, 1.0, runs, 2).statistics.rmse, std::sqrt(first * third), 1e-9);
  EXPECT_EQ(runs, 2);
}

TEST(ClosurePrediction, IsUndefinedWithAReason) {
  const auto reason = [](Problem problem) {
    int runs = 0;
    return why<Undefined>([&] { predicted(problem, 1.0, runs); });
  };
  Problem problem = stretched();
  problem.closures.resize(2);
  EXPECT_EQ(reason(problem), "needs closures at two places, found 1");
  problem = stretched();
  problem.keyframes.back().world_from_body.translation.x() += 0.6;
  EXPECT_EQ(reason(problem), "the keyframes are not the poses of the odometry");
  problem = stretched();
  problem.closures[0].scale = 1.1;
  EXPECT_EQ(reason(problem), "an edge changes the scale (factor 1.1), but the keyframes are rigid");
  Evaluation files;
  files.context.problem = &problem;
  EXPECT_EQ(why<Undefined>([&] { closure_prediction(files, {}); }),
            "needs a method that can run again, which files do not have");
}

TEST(ClosureResidual, ByHandIncludingMahalanobis) {
  Problem problem;
  problem.keyframes = test::along_x({0, 1, 2, 3, 4, 5}).keyframes;
  Matrix6 information = Matrix6::Identity();
  information.diagonal() << 4.0, 1.0, 1.0, 1.0, 1.0, 9.0;
  Pose measured;  // closure from 5 to 0: 2 m straight ahead; the estimate gives 5 m
  measured.translation.x() = 2.0;
  problem.closures.push_back({0, 5, measured, information});
  measured.translation.x() = 3.0;  // closure from 3 to 0: 3 m, rotated by 90 degrees
  measured.rotation = exp_so3({0.0, 0.0, std::numbers::pi / 2.0});
  problem.closures.push_back({0, 3, measured, information});
  const EvaluatedCell cell(problem.keyframes, problem, problem.keyframes, kAsIs);
  const auto scores = closure_residual(cell.evaluation);
  EXPECT_NEAR(find(scores, "translation", "3d").sse, 9.0, 1e-12);
  EXPECT_NEAR(find(scores, "rotation", "3d").max, 90.0, 1e-12);
  // e = (3, 0, 0, 0, 0, 0) has weight 2, e = (0, 0, 0, 0, 0, -pi / 2) has weight 3.
  EXPECT_NEAR(find(scores, "mahalanobis", "3d").max, 6.0, 1e-12);
  EXPECT_NEAR(find(scores, "mahalanobis", "3d").min, 1.5 * std::numbers::pi, 1e-12);
}

TEST(ClosureResidual, DoesNotCareWhereTheEstimateLies) {
  std::mt19937_64 random(2);
  const Trajectory truth = test::hand_held_truth();
  const Problem problem =
      test::drifting(truth, twist({0.002, 0, 0}, {0, 0, 0.003}), {{0, 59}, {3, 30}});
  const EvaluatedCell here(truth, problem, problem.keyframes);
  const Pose elsewhere = test::random_pose(random, 30.0, 2.0);
  const EvaluatedCell there(truth, problem, test::moved_by(elsewhere, 1.0, problem.keyframes));
  for (const char* relation : {"translation", "rotation", "mahalanobis"}) {
    const double residual = find(closure_residual(here.evaluation), relation, "3d").rmse;
    EXPECT_GT(residual, 0.0);
    EXPECT_NEAR(
        find(closure_residual(there.evaluation), relation, "3d").rmse, residual, 1e-10 * residual);
  }
}

TEST(ClosureResidual, IsZeroForTheTruth) {
  const Trajectory truth = test::hand_held_truth();
  const Problem problem = test::drifting(truth, twist({0.01, 0, 0}, {0, 0, 0}), {{0, 59}});
  const EvaluatedCell cell(truth, problem, truth);
  for (const Score& score : closure_residual(cell.evaluation)) {
    EXPECT_NEAR(score.statistics.max, 0.0, 1e-10) << score.relation;
  }
}

TEST(ClosureResidual, RefusesWhereThereIsNothingToMeasure) {
  const Trajectory poses = test::along_x({0, 1, 2, 3, 4, 5}).keyframes;
  Problem problem;
  problem.keyframes = poses;
  EXPECT_EQ(why<std::runtime_error>([&] { closure_residual(evaluate(poses, poses, kAsIs)); }),
            "needs loop closures, which files do not have");
  const EvaluatedCell none(poses, problem, poses, kAsIs);
  EXPECT_EQ(why<std::runtime_error>([&] { closure_residual(none.evaluation); }),
            "needs loop closures; the sequence has none");
  problem.closures.push_back({0, 5, {}, Matrix6::Identity(), 3.0});
  const EvaluatedCell scaled(poses, problem, poses, kAsIs);
  EXPECT_THROW(closure_residual(scaled.evaluation), std::runtime_error);
}

/// Positions by formula, over 0..end after `zero`.
class Formula final : public Curve {
 public:
  Formula(double zero, double end, std::function<Vector3(double)> position)
      : zero_(zero), end_(end), position_(std::move(position)) {}
  double start() const override { return zero_; }
  double end() const override { return zero_ + end_; }
  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override {
    for (std::size_t k = 0; k < times.size(); ++k) {
      poses[k] = {Rotation::Identity(), position_(times[k] - zero_)};
    }
  }

 private:
  double zero_;
  double end_;
  std::function<Vector3(double)> position_;
};

/// A keyframe every 0.5 s for 4 s; the reference samples the formula with `rate`.
EvaluatedCell formula_cell(double zero,
                           const std::function<Vector3(double)>& position,
                           double rate = 100.0) {
  const auto sampled = [&](double every) {
    std::vector<double> times;
    for (double k = 0.0; k * every <= 4.0 + 1e-9; ++k) times.push_back(zero + k * every);
    times.back() = zero + 4.0;
    return Formula(zero, 4.0, position).sample(times);
  };
  Problem problem;
  problem.keyframes = sampled(0.5);
  return {sampled(1.0 / rate),
          std::move(problem),
          std::make_unique<Formula>(zero, 4.0, position),
          Times::dense,
          kAsIs};
}

class JumpsAt : public testing::TestWithParam<double> {};

TEST_P(JumpsAt, ByHandOnPieces) {
  const EvaluatedCell cell = formula_cell(GetParam(), [](double t) -> Vector3 {
    if (t < 2.0) return {t, t * t, 0.0};  // velocity (1, 4, 0), acceleration (0, 2, 0) at 2
    return {t + 3.0, 4.0, 4.0};           // velocity (1, 0, 0), acceleration 0
  });
  const auto scores = jumps(cell.evaluation, {});
  EXPECT_EQ(find(scores, "position", "3d").count, 7u);
  EXPECT_NEAR(find(scores, "position", "3d").max, 5.0, 1e-12);
  EXPECT_NEAR(find(scores, "velocity", "3d").max, 4.0, 1e-10);
  EXPECT_NEAR(find(scores, "acceleration", "3d").max, 2.0, 1e-8);
  EXPECT_NEAR(find(scores, "position", "3d").median, 0.0, 1e-13);
  EXPECT_NEAR(find(scores, "velocity", "3d").median, 0.0, 1e-11);
  EXPECT_NEAR(find(scores, "acceleration", "3d").median, 0.0, 1e-9);
}

// Stamps since 1970 have a resolution of 2.4e-7 s, which must not affect the derivatives.
INSTANTIATE_TEST_SUITE_P(Stamps, JumpsAt, testing::Values(0.0, 1305031910.765));

TEST(Jumps, SmoothCurvesHaveNone) {
  const EvaluatedCell cell = formula_cell(7.0, [](double t) -> Vector3 {
    return {std::sin(t), std::cos(0.7 * t), std::exp(0.2 * t)};
  });
  const auto scores = jumps(cell.evaluation, {.reach = 0.02});
  EXPECT_NEAR(find(scores, "position", "3d").max, 0.0, 5e-12);
  EXPECT_NEAR(find(scores, "velocity", "3d").max, 0.0, 1e-6);
  EXPECT_LT(find(scores, "acceleration", "3d").max, 1e-4);
}

TEST(Jumps, APolylineKinksByTheChangeOfItsVelocity) {
  Trajectory poses(3);
  for (std::size_t i = 0; i < 3; ++i) poses[i].stamp = static_cast<double>(i);
  poses[1].world_from_body.translation = Vector3(1.0, 0.0, 0.0);
  poses[2].world_from_body.translation = Vector3(1.0, 2.0, 0.0);
  Problem problem;
  problem.keyframes = poses;
  const EvaluatedCell cell(poses, problem, poses, kAsIs);
  const auto scores = jumps(cell.evaluation, {});
  EXPECT_NEAR(find(scores, "position", "3d").max, 0.0, 1e-14);
  EXPECT_NEAR(find(scores, "velocity", "3d").max, std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(find(scores, "acceleration", "3d").max, 0.0, 1e-10);
}

TEST(Jumps, RefusesFilesAndShortCurves) {
  Trajectory poses(2);
  poses[1].stamp = 1.0;
  poses[1].world_from_body.translation.x() = 1.0;
  EXPECT_EQ(why<std::runtime_error>([&] { jumps(evaluate(poses, poses, kAsIs), {}); }),
            "needs a curve, which files do not have");
  Problem problem;
  problem.keyframes = poses;
  const EvaluatedCell cell(poses, problem, poses, kAsIs);
  EXPECT_EQ(why<std::runtime_error>([&] { jumps(cell.evaluation, {}); }),
            "needs at least three keyframes");
  problem.keyframes.push_back({1.0 + 1e-15, poses[1].world_from_body});
  problem.keyframes[2].stamp = std::nextafter(1.0, 2.0);
  const EvaluatedCell coarse(poses, problem, problem.keyframes, kAsIs);
  EXPECT_EQ(why<std::runtime_error>([&] { jumps(coarse.evaluation, {}); }),
            "the stamps around 1.0 s are too coarse for four samples next to a keyframe");
}

TEST(Jerk, ByHandOnACubic) {
  for (const double zero : {0.0, 1305031910.765}) {
    const EvaluatedCell cell = formula_cell(zero, [](double t) -> Vector3 {
      return {2.0 * t * t * t, t, -1.0};
    });
    const auto scores = jerk(cell.evaluation, {.rate = 10.0});
    EXPECT_GT(find(scores, "estimate", "3d").count, 36u);
    EXPECT_NEAR(find(scores, "estimate", "3d").min, 12.0, 1e-6);
    EXPECT_NEAR(find(scores, "estimate", "3d").max, 12.0, 1e-6);
    // The reference is interpolated linearly over 10 ms.
    EXPECT_NEAR(find(scores, "reference", "3d").mean, 12.0, 1.0);
    EXPECT_NEAR(find(scores, "ratio", "3d").rmse, 1.0, 0.1);
  }
}

TEST(Jerk, LeavesOutIntervalsAcrossAReferenceGap) {
  const auto cubic = [](double t) -> Vector3 { return {2.0 * t * t * t, t, -1.0}; };
  const EvaluatedCell complete = formula_cell(0.0, cubic);
  Trajectory holed;
  for (const StampedPose& pose : complete.reference) {
    if (pose.stamp < 1.005 || pose.stamp > 1.995) holed.push_back(pose);
  }
  Evaluation evaluation = complete.evaluation;
  evaluation.context.reference = &holed;
  const auto scores = jerk(evaluation, {.rate = 10.0});
  const std::size_t all = find(jerk(complete.evaluation, {.rate = 10.0}), "estimate", "3d").count;
  EXPECT_EQ(find(scores, "estimate", "3d").count, all - 12);  // begins 0.8 .. 1.9
  EXPECT_NEAR(find(scores, "reference", "3d").mean, 12.0, 1.0);
  EXPECT_THROW(jerk(evaluation, {.rate = 0.1}), std::runtime_error);
  EXPECT_THROW(jerk(evaluation, {.rate = 1e12}), std::runtime_error);
}

TEST(Jerk, OfAStraightReferenceHasNoRatio) {
  const Problem problem = test::along_x({0, 1, 2, 3, 4});
  const EvaluatedCell cell(problem.keyframes, problem, problem.keyframes, kAsIs);
  EXPECT_EQ(jerk(cell.evaluation, {.rate = 1.0, .max_gap = 2.0}).at(2).why_undefined,
            "the reference has zero jerk");
}

}  // namespace
}  // namespace loopbench::correction_test
