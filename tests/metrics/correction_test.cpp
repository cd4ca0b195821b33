/// Metrics of a correction: gain, closures, local shape.
#include <cmath>
#include <numbers>

#include "evaluated_cell.hpp"
#include "metrics/correction/closure_residual.hpp"
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
  const EvaluatedCell here(
      truth, problem, std::make_unique<Polyline>(problem.keyframes), Times::keyframes);
  const Pose elsewhere = test::random_pose(random, 30.0, 2.0);
  const EvaluatedCell there(
      truth,
      problem,
      std::make_unique<Polyline>(test::moved_by(elsewhere, 1.0, problem.keyframes)),
      Times::keyframes);
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
  const EvaluatedCell cell(truth, problem, std::make_unique<Polyline>(truth), Times::keyframes);
  for (const Score& score : closure_residual(cell.evaluation)) {
    EXPECT_LT(score.statistics.max, 1e-10) << score.relation;
  }
}

TEST(ClosureResidual, RefusesWhereThereIsNothingToMeasure) {
  const Trajectory poses = line({0, 0, 0, 0, 0, 0});
  Problem problem;
  problem.keyframes = poses;
  EXPECT_EQ(why<std::runtime_error>([&] { closure_residual(evaluate(poses, poses, kAsIs)); }),
            "closure_residual: needs loop closures, which files do not have");
  const EvaluatedCell none = corrected(problem, poses, poses);
  EXPECT_EQ(why<std::runtime_error>([&] { closure_residual(none.evaluation); }),
            "closure_residual: needs loop closures; the sequence has none");
  problem.closures.push_back({0, 5, {}, Matrix6::Identity(), 3.0});
  const EvaluatedCell scaled = corrected(problem, poses, poses);
  EXPECT_THROW(closure_residual(scaled.evaluation), std::runtime_error);
}

}  // namespace
}  // namespace loopbench::correction_test
