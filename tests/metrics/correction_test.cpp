/// Metrics of a correction: gain, closures, local shape.
#include <cmath>
#include <numbers>

#include "evaluated_cell.hpp"
#include "metrics/correction/closure_residual.hpp"
#include "metrics/correction/gain_along.hpp"
#include "metrics/correction/local_shape.hpp"
#include "support.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::correction_test {

using namespace metrics;

namespace {

using test::EvaluatedCell;
using test::find;
using test::why;

const Protocol kAsIs{.align = Align::none};

/// Six poses 1 m apart along x; `strays` offsets the positions along y.
Trajectory line(const std::array<double, 6>& strays) {
  Trajectory out(6);
  for (std::size_t i = 0; i < 6; ++i) {
    out[i].stamp = static_cast<double>(i);
    out[i].world_from_body.translation = Vector3(static_cast<double>(i), strays[i], 0.0);
  }
  return out;
}

EvaluatedCell corrected(Problem problem,
                        Trajectory keyframes,
                        const Trajectory& truth,
                        const Protocol& rules = kAsIs) {
  return {truth,
          std::move(problem),
          std::make_unique<Polyline>(std::move(keyframes)),
          Times::keyframes,
          rules};
}

TEST(GainAlong, ByHand) {
  Problem problem;
  problem.keyframes = line({0.0, 2.0, 2.0, 4.0, 4.0, 4.0});
  const EvaluatedCell cell =
      corrected(problem, line({0.0, 1.0, 2.0, 2.0, 8.0, 0.0}), line({0, 0, 0, 0, 0, 0}));
  const auto scores = gain_along(cell.evaluation, {});
  // Squares before 0 4 4 16 16 16, after 0 1 4 4 64 0; each third of the path has two poses.
  EXPECT_NEAR(
      find(scores, "translation", "3d").rmse, 100.0 * (1.0 - std::sqrt(73.0 / 56.0)), 1e-12);
  EXPECT_EQ(find(scores, "translation", "3d").count, 6u);
  const Protocol by_mean{.align = Align::none, .statistic = Statistic::mean};
  const EvaluatedCell again =
      corrected(problem, line({0.0, 1.0, 2.0, 2.0, 8.0, 0.0}), line({0, 0, 0, 0, 0, 0}), by_mean);
  const auto means = gain_along(again.evaluation, {});
  EXPECT_NEAR(find(means, "translation", "y").mean, 100.0 * (1.0 - 13.0 / 16.0), 1e-12);
  EXPECT_NEAR(find(scores, "first_third", "3d").rmse, 50.0, 1e-12);
  EXPECT_NEAR(
      find(scores, "middle_third", "3d").rmse, 100.0 * (1.0 - std::sqrt(8.0 / 20.0)), 1e-12);
  EXPECT_NEAR(find(scores, "last_third", "3d").rmse, 100.0 * (1.0 - std::sqrt(64.0 / 32.0)), 1e-12);
  EXPECT_NEAR(find(scores, "improved", "").mean, 100.0 * 3.0 / 6.0, 1e-12);
  EXPECT_NEAR(find(scores, "worsened", "").mean, 100.0 / 6.0, 1e-12);
}

TEST(GainAlong, OnNoErrorIsUndefinedAndSaysSo) {
  Problem problem;
  problem.keyframes = line({0, 1, 0, 1, 0, 1});
  const EvaluatedCell cell = corrected(problem, line({0, 0, 0, 0, 0, 0}), line({0, 0, 0, 0, 0, 0}));
  for (const Score& score : gain_along(cell.evaluation, {})) {
    const bool is_free = score.axis == "x" || score.axis == "z" || score.relation == "angle";
    EXPECT_EQ(score.why_undefined, is_free ? "the error before correction is zero" : "")
        << score.axis;
    if (score.unit == "%" && score.axis != "" && !is_free) {
      EXPECT_EQ(score.statistics.rmse, 100.0);
    }
  }
}

TEST(GainAlong, WritesNoZeroWhereItIsUndefined) {
  // Errors before 0 0 0 1 0 0: the rmse has a gain, the median and the minimum have none.
  Problem problem;
  problem.keyframes = line({0, 0, 0, 1, 0, 0});
  const auto gained = [&](Statistic statistic) {
    const Protocol rules{.align = Align::none, .statistic = statistic};
    const EvaluatedCell cell =
        corrected(problem, line({0, 0, 0, 3, 0, 0}), line({0, 0, 0, 0, 0, 0}), rules);
    return gain_along(cell.evaluation, {}).front();
  };
  for (const Statistic statistic : {Statistic::rmse, Statistic::mean}) {
    const Statistics got = gained(statistic).statistics;
    for (const double number : {got.rmse, got.mean, got.median, got.min, got.max}) {
      EXPECT_NEAR(number, -200.0, 1e-12);
    }
  }
  EXPECT_EQ(gained(Statistic::median).why_undefined, "the error before correction is zero");
}

TEST(GainAlong, IsZeroForTheRawKeyframesWhereverTheyAreEvaluated) {
  const Trajectory truth = test::hand_held_truth();
  const Problem problem = test::drifting(truth, twist({0.002, 0, 0}, {0, 0, 0.003}), {{0, 59}});
  for (const Times times : {Times::keyframes, Times::dense}) {
    const EvaluatedCell cell(truth, problem, std::make_unique<Polyline>(problem.keyframes), times);
    for (const Score& score : gain_along(cell.evaluation, {})) {
      EXPECT_EQ(score.statistics.rmse, 0.0) << score.relation << score.axis;
    }
  }
}

TEST(ClosureResidual, ByHandIncludingMahalanobis) {
  Problem problem;
  problem.keyframes = line({0, 0, 0, 0, 0, 0});
  Matrix6 information = Matrix6::Identity();
  information.diagonal() << 4.0, 1.0, 1.0, 1.0, 1.0, 9.0;
  Pose measured;  // closure from 5 to 0: 2 m straight ahead; the estimate gives 5 m
  measured.translation.x() = 2.0;
  problem.closures.push_back({0, 5, measured, information});
  measured.translation.x() = 3.0;  // closure from 3 to 0: 3 m, rotated by 90 degrees
  measured.rotation = exp_so3({0.0, 0.0, std::numbers::pi / 2.0});
  problem.closures.push_back({0, 3, measured, information});
  const EvaluatedCell cell = corrected(problem, problem.keyframes, problem.keyframes);
  const auto scores = closure_residual(cell.evaluation, {});
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
  const EvaluatedCell here(
      truth, problem, std::make_unique<Polyline>(problem.keyframes), Times::keyframes);
  const Pose elsewhere = test::random_pose(random, 30.0, 2.0);
  const EvaluatedCell there(
      truth,
      problem,
      std::make_unique<Polyline>(test::moved_by(elsewhere, 1.0, problem.keyframes)),
      Times::keyframes);
  for (const char* relation : {"translation", "rotation", "mahalanobis"}) {
    const double residual = find(closure_residual(here.evaluation, {}), relation, "3d").rmse;
    EXPECT_GT(residual, 0.0);
    EXPECT_NEAR(find(closure_residual(there.evaluation, {}), relation, "3d").rmse,
                residual,
                1e-10 * residual);
  }
  for (const Score& score : local_shape(there.evaluation, {})) {
    EXPECT_LT(score.statistics.max, 1e-10);
  }
}

TEST(ClosureResidual, IsZeroForTheTruth) {
  const Trajectory truth = test::hand_held_truth();
  const Problem problem = test::drifting(truth, twist({0.01, 0, 0}, {0, 0, 0}), {{0, 59}});
  const EvaluatedCell cell(truth, problem, std::make_unique<Polyline>(truth), Times::keyframes);
  for (const Score& score : closure_residual(cell.evaluation, {})) {
    EXPECT_LT(score.statistics.max, 1e-10) << score.relation;
  }
}

TEST(ClosureResidual, RefusesWhereThereIsNothingToMeasure) {
  const Trajectory poses = line({0, 0, 0, 0, 0, 0});
  Problem problem;
  problem.keyframes = poses;
  EXPECT_EQ(why<std::runtime_error>([&] { closure_residual(evaluate(poses, poses, kAsIs), {}); }),
            "closure_residual: needs loop closures, which files do not have");
  const EvaluatedCell none = corrected(problem, poses, poses);
  EXPECT_EQ(why<std::runtime_error>([&] { closure_residual(none.evaluation, {}); }),
            "closure_residual: needs loop closures; the sequence has none");
  problem.closures.push_back({0, 5, {}, Matrix6::Identity(), 3.0});
  const EvaluatedCell scaled = corrected(problem, poses, poses);
  EXPECT_THROW(closure_residual(scaled.evaluation, {}), std::runtime_error);
}

TEST(LocalShape, ByHand) {
  Problem problem;
  problem.keyframes = line({0, 0, 0, 0, 0, 0});
  Trajectory bent = problem.keyframes;
  for (std::size_t i = 3; i < 6; ++i) {  // one bend of 90 degrees between 2 and 3, 0.5 m pulled out
    bent[i].world_from_body.rotation = exp_so3({0.0, 0.0, std::numbers::pi / 2.0});
    bent[i].world_from_body.translation = Vector3(3.5, static_cast<double>(i) - 3.0, 0.0);
  }
  const EvaluatedCell cell = corrected(problem, bent, problem.keyframes);
  const auto scores = local_shape(cell.evaluation, {});
  EXPECT_EQ(find(scores, "translation", "3d").count, 5u);
  EXPECT_NEAR(find(scores, "translation", "3d").max, 0.5, 1e-12);
  EXPECT_NEAR(find(scores, "translation", "3d").sse, 0.25, 1e-12);
  EXPECT_NEAR(find(scores, "rotation", "3d").max, 90.0, 1e-12);
  EXPECT_NEAR(find(scores, "rotation", "3d").median, 0.0, 1e-12);
}

TEST(LocalShape, RefusesFiles) {
  const Trajectory poses = line({0, 0, 0, 0, 0, 0});
  EXPECT_EQ(why<std::runtime_error>([&] { local_shape(evaluate(poses, poses, kAsIs), {}); }),
            "local_shape: needs keyframes before correction, which files do not have");
}

}  // namespace
}  // namespace loopbench::correction_test
