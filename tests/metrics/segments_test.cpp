#include "metrics/errors/segments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "metrics/numerics/angle.hpp"
#include "metrics/pairing/segment_ends.hpp"
#include "metrics/protocols/protocol.hpp"
#include "metrics/protocols/protocols.hpp"
#include "support.hpp"

namespace loopbench::test::segments_test {
namespace {

using Pairs = std::vector<FromTo>;

std::vector<double> uneven_path(std::size_t size) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> step(0.0, 1.0);
  std::vector<double> out{0.0};
  while (out.size() < size) out.push_back(out.back() + (out.size() % 7 == 0 ? 0.0 : step(random)));
  return out;
}

TEST(SegmentPairs, NearestIsWhatLookingAtAllOfThemFinds) {
  const std::vector<double> d = uneven_path(200);
  Pairs wanted;
  for (std::size_t i = 0; i < d.size(); ++i) {
    double best = 0.2;
    std::size_t end = d.size();
    for (std::size_t j = i; j < d.size(); ++j) {
      if (std::abs(d[j] - (d[i] + 3.0)) >= best) continue;
      best = std::abs(d[j] - (d[i] + 3.0));
      end = j;
    }
    if (end < d.size()) wanted.emplace_back(i, end);
  }
  EXPECT_LT(wanted.size(), 150u);
  EXPECT_EQ(segment_pairs(d, 3.0, 0.2, SegmentEnd::nearest, 1), wanted);
}

TEST(SegmentPairs, NearestIsTheSameInBlocksOnSeveralThreads) {
  const std::vector<double> d = uneven_path(70'000);
  Pairs wanted;
  for (std::size_t i = 0; i < d.size(); ++i) {
    const double end = d[i] + 100.0;
    const auto beyond = std::lower_bound(d.begin(), d.end(), end);
    auto best = beyond;
    if (beyond == d.end() || end - *std::prev(beyond) <= *beyond - end) {
      best = std::lower_bound(d.begin(), d.end(), *std::prev(beyond));
    }
    if (std::abs(*best - end) < 0.2) wanted.emplace_back(i, best - d.begin());
  }
  EXPECT_GT(wanted.size(), 40'000u);
  EXPECT_EQ(segment_pairs(d, 100.0, 0.2, SegmentEnd::nearest, 1), wanted);
}

TEST(SegmentPairs, RpgGivesTheKthEndToTheKthPose) {
  // No pose is 1 m after pose 0; from there on every end is one pose early.
  const std::vector<double> d{0.0, 5.0, 6.0, 7.0};
  EXPECT_EQ(segment_pairs(d, 1.0, 0.2, SegmentEnd::nearest, 1), (Pairs{{1, 2}, {2, 3}}));
  EXPECT_EQ(segment_pairs(d, 1.0, 0.2, SegmentEnd::rpg, 1), (Pairs{{0, 2}, {1, 3}}));
}

TEST(SegmentPairs, BeyondIsStrictAndSteps) {
  const std::vector<double> d{0.0, 1.0, 2.0, 3.0, 4.0, 5.0};
  EXPECT_EQ(segment_pairs(d, 2.0, 0.0, SegmentEnd::beyond, 1), (Pairs{{0, 3}, {1, 4}, {2, 5}}));
  EXPECT_EQ(segment_pairs(d, 2.0, 0.0, SegmentEnd::beyond, 2), (Pairs{{0, 3}, {2, 5}}));
}

TEST(Lengths, AreMetresOrShares) {
  const std::vector<Length> got = lengths("lengths", " 8 0.5m 10% ");
  ASSERT_EQ(got.size(), 3u);
  EXPECT_EQ(got[0].of(70.0), 8.0);
  EXPECT_EQ(got[1].text, "0.5 m");
  EXPECT_EQ(got[2].text, "10%");
  EXPECT_DOUBLE_EQ(got[2].of(70.0), 7.0);
  for (const char* wrong : {"", "x", "8 km", "0", "-1", "nan", "inf", "10%%", "1e999"}) {
    EXPECT_THROW(lengths("lengths", wrong), OptionError) << wrong;
  }
}

/// A straight road of 1 m steps; the estimate is 1 % too long and rotates by 0.001 rad per step.
Evaluation road(const Protocol& protocol) {
  Trajectory reference;
  Trajectory estimate;
  for (int i = 0; i <= 1000; ++i) {
    reference.push_back({0.1 * i, {Rotation::Identity(), Vector3(i, 0.0, 0.0)}});
    estimate.push_back(
        {0.1 * i, {exp_so3(Vector3(0.0, 0.0, 0.001 * i)), Vector3(1.01 * i, 0.0, 0.0)}});
  }
  return evaluate(reference, estimate, protocol);
}

TEST(Segments, OfAStraightRoadByHand) {
  Params changes{{"association", std::string("index")}, {"align", std::string("none")}};
  changes["segments.lengths"] = std::string("10 20%");
  changes["segments.tolerance"] = std::string("0.5");
  const std::vector<Score> got = segments(road(named_protocol("loopbench", changes).rules), {});
  EXPECT_EQ(named(got, "rotation 10 m deg").count, 991u);
  EXPECT_EQ(named(got, "rotation 20% deg").count, 801u);
  EXPECT_EQ(named(got, "rotation all deg/m").count, 1792u);
  const double degree = 180.0 / M_PI;
  EXPECT_NEAR(named(got, "rotation 10 m deg").max, 0.01 * degree, 1e-12);
  EXPECT_NEAR(named(got, "yaw 10 m deg").max, 0.01 * degree, 1e-12);
  EXPECT_NEAR(named(got, "gravity 10 m deg").max, 0.0, 1e-12);
  EXPECT_NEAR(named(got, "rotation all deg/m").mean, 0.001 * degree, 1e-12);
  // From pose 0, where the estimate's orientation is correct: 10.1 m instead of 10 m.
  EXPECT_NEAR(named(got, "translation 10 m m").min, 0.1, 1e-12);
  EXPECT_NEAR(named(got, "translation 10 m %").min, 1.0, 1e-11);
}

/// Errors of sub-trajectories of 8 to 48 m, to half a metre, of 1 m steps along x.
std::vector<Score> short_road(const Trajectory& reference, const Trajectory& estimate) {
  const Protocol protocol{
      .align = Align::posyaw,
      .segments = {.lengths = "8 16 24 32 40 48", .tolerance = "0.5"},
      .ddof = 1,
  };
  return segments(evaluate(reference, estimate, protocol), {});
}

Trajectory steps_along_x(int size) {
  Trajectory out;
  for (int i = 0; i < size; ++i) out.push_back({0.1 * i, {Rotation::Identity(), Vector3(i, 0, 0)}});
  return out;
}

TEST(Segments, StartEverywhereAndStdDividesByOneLess) {
  Trajectory estimate = steps_along_x(21);
  estimate[10].world_from_body.rotation = exp_so3(Vector3(0.2, 0.0, 0.0));  // about the path
  const std::vector<Score> got = short_road(steps_along_x(21), estimate);
  std::set<std::string> axes;
  for (const Score& score : got) axes.insert(score.axis);
  EXPECT_EQ(axes, (std::set<std::string>{"all", "8 m", "16 m"}));  // 24 m and more are too long
  for (const Score& score : got) {
    if (score.axis != "8 m") continue;
    EXPECT_EQ(score.statistics.count, 13u);  // starts 0..12; 2 ends in pose 10, 10 starts there
    if (score.relation == "translation") {
      EXPECT_NEAR(score.statistics.max, 0.0, 1e-12);
    }
    if (score.relation != "rotation" || score.unit != "deg") continue;
    const double mean = 2.0 * 0.2 / 13.0;
    EXPECT_NEAR(score.statistics.mean, kDegrees * mean, 1e-9);
    const double squares = 2.0 * std::pow(0.2 - mean, 2) + 11.0 * mean * mean;
    EXPECT_NEAR(score.statistics.std, kDegrees * std::sqrt(squares / 12.0), 1e-9);
  }
}

TEST(Segments, AnEndExactlyTheToleranceOffIsNone) {
  Trajectory off = steps_along_x(2);
  off[1].world_from_body.translation.x() = 7.5;
  EXPECT_THROW(short_road(off, off), Undefined);
  off[1].world_from_body.translation.x() = 7.6;
  EXPECT_EQ(find(short_road(off, off), "translation", "8 m").count, 1u);
}

TEST(Segments, FloatAndDoubleAgreeToFloat) {
  const auto mean = [](const std::string& name) {
    return find(segments(road(named_protocol(name).rules), {}), "translation", "all");
  };
  const Statistics in_float = mean("kitti");
  const Statistics in_double = mean("kitti-double");
  EXPECT_EQ(in_float.count, in_double.count);
  EXPECT_NE(in_float.mean, in_double.mean);
  EXPECT_NEAR(in_float.mean, in_double.mean, 1e-5 * in_double.mean);
}

TEST(Segments, OfPositionsAloneAreRefused) {
  Trajectory poses;
  for (int i = 0; i < 50; ++i) {
    poses.push_back({0.1 * i, {Rotation::Identity(), Vector3(i, 0.1 * i * i, 0.0)}});
  }
  const Evaluation evaluated = evaluate(poses, poses, named_protocol("loopbench").rules);
  EXPECT_EQ(why<Undefined>([&] { segments(evaluated, {}); }).find("the reference has a constant"),
            0u);
}

TEST(Segments, WithoutAnySaysSo) {
  const Params far{{"segments.lengths", std::string("5000")}};
  EXPECT_EQ(
      why<std::runtime_error>([&] { segments(road(named_protocol("kitti", far).rules), {}); }),
      "no segment of the reference (1000.0 m) has a length of 5000 m");
}

}  // namespace
}  // namespace loopbench::test::segments_test
