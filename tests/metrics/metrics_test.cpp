#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "metrics/checks/diagnostics.hpp"
#include "metrics/errors/ate.hpp"
#include "metrics/errors/axis_error.hpp"
#include "metrics/errors/rpe.hpp"
#include "support.hpp"

namespace loopbench::test::metrics_test {
namespace {

constexpr double kRightAngle = std::numbers::pi / 2.0;

Evaluation beside(const Trajectory& reference, const Trajectory& estimate, Align type) {
  return evaluate(reference, estimate, {.align = type, .min_pairs = 1});
}

/// Three poses 1 m apart along x, 1 s apart; the estimate has known errors.
Evaluation by_hand() {
  Trajectory reference(3);
  for (std::size_t i = 0; i < 3; ++i) {
    reference[i].stamp = static_cast<double>(i);
    reference[i].world_from_body.translation.x() = static_cast<double>(i);
  }
  Trajectory estimate = reference;
  estimate[1].world_from_body.translation += Vector3(3.0, -4.0, 0.0);
  estimate[2].world_from_body.translation += Vector3(0.0, 0.0, 2.0);
  estimate[1].world_from_body.rotation = exp_so3({0.0, 0.0, kRightAngle});
  return beside(reference, estimate, Align::none);
}

TEST(Ate, ByHand) {
  const auto scores = ate(by_hand(), {});
  const Statistics metres = find(scores, "translation", "3d");
  EXPECT_EQ(metres.count, 3u);
  EXPECT_DOUBLE_EQ(metres.max, 5.0);
  EXPECT_DOUBLE_EQ(metres.mean, 7.0 / 3.0);
  EXPECT_DOUBLE_EQ(metres.rmse, std::sqrt(29.0 / 3.0));
  EXPECT_DOUBLE_EQ(metres.median, 2.0);
  EXPECT_DOUBLE_EQ(metres.min, 0.0);
  const Statistics degrees = find(scores, "rotation", "3d");
  EXPECT_NEAR(degrees.max, 90.0, 1e-13);
  EXPECT_EQ(degrees.median, 0.0);
}

TEST(AxisError, ByHandInMagnitudes) {
  const auto scores = axis_error(by_hand(), {});
  EXPECT_DOUBLE_EQ(find(scores, "translation", "x").max, 3.0);
  EXPECT_DOUBLE_EQ(find(scores, "translation", "y").max, 4.0);
  EXPECT_DOUBLE_EQ(find(scores, "translation", "y").mean, 4.0 / 3.0);
  EXPECT_DOUBLE_EQ(find(scores, "translation", "y").rmse, std::sqrt(16.0 / 3.0));
  EXPECT_DOUBLE_EQ(find(scores, "translation", "z").sse, 4.0);
}

TEST(Rpe, ByHandInTheWorldAndInTheBody) {
  // Position errors (0,0,0), (3,-4,0), (0,0,2): they change by (3,-4,0) and (-3,4,2).
  const auto world = rpe(by_hand(), {.frame = RpeFrame::world});
  EXPECT_EQ(find(world, "translation", "3d").count, 2u);
  EXPECT_DOUBLE_EQ(find(world, "translation", "x").sse, 18.0);
  EXPECT_DOUBLE_EQ(find(world, "translation", "y").sse, 32.0);
  EXPECT_DOUBLE_EQ(find(world, "translation", "z").max, 2.0);
  EXPECT_NEAR(find(world, "rotation", "3d").min, 90.0, 1e-13);

  // First step E = (4,-4,0) - (1,0,0). Second: the body is rotated by 90 degrees about z, so the
  // world motion (-2,4,2) is (4,2,2) in its frame, and E = (3,2,2).
  const auto body = rpe(by_hand(), {});
  EXPECT_NEAR(find(body, "translation", "x").sse, 9.0 + 9.0, 1e-13);
  EXPECT_NEAR(find(body, "translation", "y").sse, 16.0 + 4.0, 1e-13);
  EXPECT_NEAR(find(body, "translation", "z").sse, 4.0, 1e-13);
  EXPECT_NEAR(find(body, "translation", "3d").sse, 42.0, 1e-13);
}

TEST(Rpe, DeltaCountsFramesSecondsOrMetres) {
  std::mt19937_64 random(1);
  const Trajectory reference = random_walk(random, 101);  // 0.1 s apart
  const Evaluation e = beside(reference, noisy(random, reference, 0.1, 0.1), Align::se3);
  const auto frames = rpe(e, {.delta = 10, .unit = DeltaUnit::frames});
  const auto seconds = rpe(e, {.delta = 1.0, .unit = DeltaUnit::s, .tolerance = 0.01});
  EXPECT_EQ(find(frames, "translation", "3d").count, 91u);
  EXPECT_EQ(find(frames, "translation", "3d").rmse, find(seconds, "translation", "3d").rmse);
  const auto metres = rpe(e, {.delta = 2.0, .unit = DeltaUnit::m});
  EXPECT_GT(find(metres, "translation", "3d").count, 10u);
}

TEST(Rpe, RefusesWhatItCannotMeasure) {
  EXPECT_EQ(why<std::runtime_error>([] { rpe(by_hand(), {.delta = 3}); }),
            "none of 3 poses is 3.0 frames before another");
  EXPECT_EQ(why<std::runtime_error>([] { rpe(by_hand(), {.delta = 9, .unit = DeltaUnit::m}); }),
            "none of 3 poses is 9.0 m before another");
  EXPECT_THROW(rpe(by_hand(), {.delta = 1e30}), std::runtime_error);
}

TEST(CoverageMetric, IsTwoSharesAndTheTimeBridged) {
  Evaluation e = by_hand();
  e.coverage = {.pairs = 3, .possible = 4, .span = 0.5, .bridged = 12.5};
  const auto scores = coverage(e);
  EXPECT_EQ(find(scores, "share", "").mean, 0.75);
  EXPECT_EQ(find(scores, "share", "").count, 3u);
  EXPECT_EQ(find(scores, "span", "").rmse, 0.5);
  EXPECT_EQ(find(scores, "bridged", "").rmse, 12.5);
}

/// The metrics that are errors of pairs: zero for a perfect estimate, never negative.
std::vector<MetricEntry> pair_errors() {
  std::vector<MetricEntry> out;
  for (const MetricEntry& entry : metrics::metrics()) {
    for (const char* name : {"ate", "axis_error", "rpe", "along_cross"}) {
      if (entry.name == name) out.push_back(entry);
    }
  }
  return out;
}

TEST(Catalogue, ReadsOptionsAndRefusesBadOnes) {
  for (const MetricEntry& entry : metrics::metrics()) {
    EXPECT_THROW(entry.score(by_hand(), {{"nonsense", 1.0}}), OptionError) << entry.name;
  }
  for (const MetricEntry& entry : pair_errors()) {
    EXPECT_FALSE(entry.score(by_hand(), {}).empty()) << entry.name;
    for (const Score& score : entry.score(by_hand(), {})) {
      EXPECT_GT(score.statistics.count, 0u) << entry.name;
    }
  }
  const std::vector<MetricEntry> known = metrics::metrics();
  const auto rpe = std::ranges::find(known, "rpe", &MetricEntry::name);
  const auto text = why<OptionError>([&] { rpe->score(by_hand(), {{"delta", 0.0}}); });
  EXPECT_NE(text.find("delta > 0"), std::string::npos) << text;
}

/// The same laws on random walks with errors of any size.
class Laws : public testing::TestWithParam<double> {
 protected:
  std::mt19937_64 random_{17};
  Trajectory reference_ = random_walk(random_, 200);
  Trajectory estimate_ = noisy(random_, reference_, GetParam(), GetParam());
};

TEST_P(Laws, SquaresOfAxesAddUp) {
  const Evaluation e = beside(reference_, estimate_, Align::se3);
  const double complete = find(ate(e, {}), "translation", "3d").sse;
  double parts = 0.0;
  double body_parts = 0.0;
  for (const char* axis : {"x", "y", "z"}) {
    parts += find(axis_error(e, {}), "translation", axis).sse;
    body_parts += find(rpe(e, {}), "translation", axis).sse;
  }
  EXPECT_NEAR(parts, complete, 1e-12 * complete);
  const double relative = find(rpe(e, {}), "translation", "3d").sse;
  EXPECT_NEAR(body_parts, relative, 1e-12 * relative);
}

TEST_P(Laws, MeanIsAtMostRmseIsAtMostMax) {
  const Evaluation e = beside(reference_, estimate_, Align::se3);
  for (const MetricEntry& entry : pair_errors()) {
    for (const Score& score : entry.score(e, {})) {
      const Statistics& s = score.statistics;
      EXPECT_LE(s.min, s.median) << entry.name;
      EXPECT_LE(s.median, s.max) << entry.name;
      EXPECT_LE(s.mean, s.rmse * (1.0 + 1e-12)) << entry.name;
      EXPECT_LE(s.rmse, s.max * (1.0 + 1e-12)) << entry.name;
      EXPECT_NEAR(s.rmse * s.rmse, s.mean * s.mean + s.std * s.std, 1e-12 * s.rmse * s.rmse);
    }
  }
}

// (e_j - e_i)^2 <= 2 e_j^2 + 2 e_i^2, and each error occurs in at most two of the n - D pairs.
TEST_P(Laws, AxisRpeIsBoundedByAxisAte) {
  const Evaluation e = beside(reference_, estimate_, Align::se3);
  const double n = 200.0;
  for (const double delta : {1.0, 7.0, 150.0}) {
    const auto relative = rpe(e, {.delta = delta, .frame = RpeFrame::world});
    for (const char* axis : {"x", "y", "z"}) {
      EXPECT_LE(find(relative, "translation", axis).rmse,
                2.0 * find(axis_error(e, {}), "translation", axis).rmse *
                    std::sqrt(n / (n - delta)) * (1.0 + 1e-12));
    }
  }
}

TEST_P(Laws, WholeNumbersDoNotCareHowTheWorldIsTurned) {
  const Pose motion = random_pose(random_, 50.0, 2.0);
  const Evaluation here = beside(reference_, estimate_, Align::se3);
  const Evaluation there =
      beside(moved_by(motion, 1.0, reference_), moved_by(motion, 1.0, estimate_), Align::se3);
  for (const MetricEntry& entry : pair_errors()) {
    const auto a = entry.score(here, {});
    const auto b = entry.score(there, {});
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (a[i].axis != "3d") continue;
      EXPECT_NEAR(a[i].statistics.rmse, b[i].statistics.rmse, 1e-10) << entry.name;
      EXPECT_NEAR(a[i].statistics.max, b[i].statistics.max, 1e-10) << entry.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Laws, testing::Values(1e-6, 1e-3, 0.1, 1.0));

void expect_zero(const Evaluation& e) {
  for (const MetricEntry& entry : pair_errors()) {
    for (const Score& score : entry.score(e, {})) {
      EXPECT_NEAR(score.statistics.max, 0.0, 1e-11) << entry.name << " " << score.relation;
    }
  }
}

TEST(Metrics, PerfectInputGivesZeroUnderEveryAlignment) {
  std::mt19937_64 random(5);
  const Trajectory reference = random_walk(random, 300);
  for (const auto& [name, type] : choices(Align{})) {
    expect_zero(beside(reference, reference, type));
  }
}

TEST(Metrics, MovedInputGivesZeroUnderSe3AndScaledUnderSim3) {
  std::mt19937_64 random(6);
  const Trajectory reference = random_walk(random, 300);
  const Pose elsewhere = random_pose(random, 20.0, 2.0);
  expect_zero(beside(reference, moved_by(elsewhere, 1.0, reference), Align::se3));
  expect_zero(beside(reference, moved_by(elsewhere, 1.0, reference), Align::origin));
  expect_zero(beside(reference, moved_by(elsewhere, 0.37, reference), Align::sim3));
}

}  // namespace
}  // namespace loopbench::test::metrics_test
