#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "manifold_paths.hpp"
#include "methods/smoothers/manifold/dm.hpp"
#include "methods/smoothers/manifold/segments.hpp"
#include "methods/smoothers/manifold/windows.hpp"
#include "tests/support/corrected.hpp"

namespace loopbench::methods::manifold::manifold_segments_test {
namespace {

using Ranges = std::vector<NodeRange>;
using Windows = std::vector<Window>;

TEST(SpeedRule, SplitsWhereTheSpeedLeavesTheBand) {
  const auto segments_by =
      [](SpeedRule rule, std::optional<double> band, const std::vector<double>& speeds) {
        return segments(Nodes(with_speeds(speeds)), {.speed_band = band, .speed = rule});
      };
  const auto range = SpeedRule::range;
  EXPECT_EQ(segments_by(range, 0.3, {1.0, 1.2, 1.1, 2.0, 2.1}), (Ranges{{0, 3}, {3, 5}}));
  EXPECT_EQ(segments_by(range, 0.3, {1.0, 1.2, 1.4, 1.6}), (Ranges{{0, 2}, {2, 4}}));
  EXPECT_EQ(segments_by(range, std::nullopt, {0.0, 0.0, 0.0}), (Ranges{{0, 3}}));
  // Without a band, the mean speed 1.5: 2.6 - 1.2 = 1.4 fits, 2.6 - 0.7 = 1.9 does not.
  EXPECT_EQ(segments_by(range, std::nullopt, {1.2, 2.6, 0.7, 1.5}), (Ranges{{0, 2}, {2, 4}}));
  // Compared with the previous edge.
  EXPECT_EQ(segments_by(SpeedRule::adjacent, 0.3, {1.0, 1.2, 1.4, 1.6, 2.0}),
            (Ranges{{0, 4}, {4, 5}}));
}

TEST(Kappa, EveryDefinitionMatchesAHandComputedRightAngle) {
  // Steps of 1 m in 1 s and 3 m in 1 s at a right angle, the second one upwards.
  const Nodes nodes(through({{0, 0, 0}, {1, 0, 0}, {1, 0, 3}}));
  const auto at_corner = [&](Kappa kappa, CurveSpace plane) {
    const auto all = kappas(nodes, kappa, plane, Vector3::UnitZ());
    EXPECT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0], 0.0);
    EXPECT_EQ(all[2], 0.0);
    return all[1];
  };
  const double right = std::numbers::pi / 2.0;
  EXPECT_NEAR(at_corner(Kappa::turn_per_kf, CurveSpace::space), right, 1e-15);
  EXPECT_NEAR(at_corner(Kappa::menger, CurveSpace::space), 2.0 / std::sqrt(10.0), 1e-15);
  EXPECT_NEAR(at_corner(Kappa::dtheta_dt, CurveSpace::space), right, 1e-15);
  EXPECT_EQ(at_corner(Kappa::turn_per_kf, CurveSpace::plane), 0.0);  // at rest in the projection
}

TEST(Kappa, OfACircleIsOneOverItsRadius) {
  std::vector<Vector3> points;
  for (int i = 0; i < 40; ++i)
    points.push_back({4 * std::cos(0.05 * i), 4 * std::sin(0.05 * i), 0});
  const Nodes nodes(through(points));
  EXPECT_NEAR(kappas(nodes, Kappa::menger, CurveSpace::plane, Vector3::UnitZ())[20], 0.25, 1e-4);
}

TEST(Scheme, SlidingWindowsOfOddSizeAreCentredOnTheirFirstNode) {
  EXPECT_EQ(windows({2, 6}, 3, 9, Scheme::sliding_blend),
            (Windows{{{2, 4}, {2, 3}}, {{2, 4}, {3, 4}}, {{3, 5}, {4, 5}}, {{4, 6}, {5, 6}}}));
}

TEST(Scheme, SlidingWindowsOfEvenSizeAreCentredOnTheirEdge) {
  EXPECT_EQ(windows({0, 5}, 4, 6, Scheme::sliding_blend),
            (Windows{{{0, 3}, {0, 1}},
                     {{0, 3}, {1, 2}},
                     {{1, 4}, {2, 3}},
                     {{2, 5}, {3, 4}},
                     {{2, 5}, {4, 5}}}));
}

TEST(Scheme, OnePerSegmentSubsamplesEvenly) {
  const auto one = windows({10, 20}, 4, 30, Scheme::one_per_segment);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].owned, (NodeRange{10, 20}));
  EXPECT_EQ(picked(one[0]), (std::vector<std::size_t>{10, 13, 17, 20}));
  EXPECT_EQ(picked({{3, 6}, {3, 6}}), (std::vector<std::size_t>{3, 4, 5, 6}));
}

TEST(Scheme, FirstNRepresentTheSegment) {
  EXPECT_EQ(windows({10, 20}, 4, 30, Scheme::first_n), (Windows{{{10, 13}, {10, 20}}}));
}

TEST(Scheme, EverySchemeOwnsEveryEdgeOnce) {
  for (const auto& [name, scheme] : choices(Scheme{})) {
    for (std::size_t size = 3; size <= 8; ++size) {
      for (std::size_t last = 1; last < 20; ++last) {
        std::size_t edge = 0;
        for (const Window& window : windows({0, last}, size, last + 1, scheme)) {
          EXPECT_EQ(window.owned.first, edge) << name;
          EXPECT_LE(window.fitted.last, last) << name;
          edge = window.owned.last;
        }
        EXPECT_EQ(edge, last) << name;
      }
    }
  }
}

TEST(DmReport, ListsSegmentsAndWindowsAsSections) {
  const Trajectory keyframes = wandering(60, 5);
  Report report;
  Dm({.planar = 4, .spatial = 7}).smooth(keyframes_only(keyframes), report);
  std::map<std::string, std::vector<Section>> kinds;
  for (const Section& section : report.sections) kinds[section.kind].push_back(section);
  const auto counted = [&](const std::string& name) {
    return static_cast<std::size_t>(test::count(report, name));
  };
  EXPECT_EQ(kinds["segment"].size(), counted("segments"));
  EXPECT_EQ(kinds["window"].size(), counted("windows"));
  EXPECT_EQ(kinds["spatial window"].size(), counted("spatial_windows"));
  EXPECT_GT(kinds["segment"].size(), 1u);
  for (const char* kind : {"segment", "window", "spatial window"}) {  // sections are adjacent
    double previous_end = keyframes.front().stamp;
    for (const Section& section : kinds[kind]) {
      EXPECT_EQ(section.begin, previous_end) << kind;
      previous_end = section.end;
      EXPECT_EQ(section.what.empty(), section.kind == "segment");
    }
    EXPECT_EQ(previous_end, keyframes.back().stamp) << kind;
  }
}

TEST(Segments, ASharpTurnStartsANewSegmentWithNewSpeeds) {
  // Speeds 1.0 1.2 | 1.4 1.4: within a band of 0.3 only if the corner at node 2 starts a new
  // segment.
  const Nodes nodes(through({{0, 0, 0}, {1.0, 0, 0}, {2.2, 0, 0}, {2.2, 0, 1.4}, {2.2, 0, 2.8}}));
  EXPECT_EQ(segments(nodes, {0.3, 0.75}), (Ranges{{0, 2}, {2, 4}}));
}

TEST(Windows, ShareTheirEndNodesAndTheLastOneReusesEarlierNodes) {
  EXPECT_EQ(windows({0, 6}, 3, 7), (Windows{{{0, 2}, {0, 2}}, {{2, 4}, {2, 4}}, {{4, 6}, {4, 6}}}));
  EXPECT_EQ(windows({0, 5}, 4, 9), (Windows{{{0, 3}, {0, 3}}, {{2, 5}, {3, 5}}}));
}

TEST(Windows, ShortSegmentBorrowsFromBothNeighbours) {
  EXPECT_EQ(windows({4, 5}, 4, 10), (Windows{{{3, 6}, {4, 5}}}));
  EXPECT_EQ(windows({4, 5}, 3, 10), (Windows{{{3, 5}, {4, 5}}}));
  EXPECT_EQ(windows({0, 1}, 4, 10), (Windows{{{0, 3}, {0, 1}}}));
  EXPECT_EQ(windows({8, 9}, 5, 10), (Windows{{{5, 9}, {8, 9}}}));
  EXPECT_EQ(windows({1, 2}, 5, 3), (Windows{{{0, 2}, {1, 2}}}));  // all nodes
}

// Keyframes at 0 s and 3 s, tracked frames at `stamps`.
Problem with_gap(const std::vector<double>& stamps) {
  Problem out = keyframes_only({{0.0, {}}, {3.0, {}}});
  for (const double stamp : stamps) {
    out.frames.push_back({stamp, {Rotation::Identity(), {stamp, 7.0, 0.0}}});
  }
  return out;
}

TEST(QuasiKeyframes, AreTheTrackedFramesNearestToEqualParts) {
  // Three parts: divisions at 1 s and 2 s.
  const NodesWithQuasiKeyframes dense =
      with_quasi_keyframes(with_gap({0.4, 0.9, 1.3, 1.7, 2.2, 2.9}), {});
  EXPECT_EQ(stamps(dense.nodes), (std::vector{0.0, 0.9, 2.2, 3.0}));
  EXPECT_EQ(dense.nodes[1].world_from_body.translation, Vector3(0.9, 7.0, 0.0));
  EXPECT_EQ(dense.inserted, 2u);
  EXPECT_EQ(dense.gaps_left, 0u);
}

TEST(QuasiKeyframes, AreNeverInterpolated) {
  const NodesWithQuasiKeyframes dense = with_quasi_keyframes(with_gap({-1.0, 0.0, 3.0, 4.0}), {});
  EXPECT_EQ(stamps(dense.nodes), (std::vector{0.0, 3.0}));
  EXPECT_EQ(dense.gaps_left, 1u);
}

TEST(QuasiKeyframes, OneFrameIsTakenOnce) {
  EXPECT_EQ(stamps(with_quasi_keyframes(with_gap({1.5}), {}).nodes), (std::vector{0.0, 1.5, 3.0}));
}

TEST(QuasiKeyframes, AreInsertedForLargeRotations) {
  Problem problem = with_gap({1.4});
  problem.keyframes[1].stamp = 2.0;
  problem.keyframes[1].world_from_body.rotation = exp_so3({0.0, 0.0, 1.2});
  EXPECT_EQ(with_quasi_keyframes(problem, {std::nullopt, 1.09}).inserted, 1u);
  EXPECT_EQ(with_quasi_keyframes(problem, {std::nullopt, 1.3}).inserted, 0u);
  EXPECT_EQ(with_quasi_keyframes(problem, {std::nullopt, std::nullopt}).inserted, 0u);
}

TEST(QuasiKeyframes, AGapOfExactlyTheLimitIsKept) {
  Problem problem = with_gap({0.5});
  problem.keyframes[1].stamp = 1.0 + 1e-9;
  const NodesWithQuasiKeyframes dense = with_quasi_keyframes(problem, {});
  EXPECT_EQ(dense.inserted + dense.gaps_left, 0u);
}

}  // namespace
}  // namespace loopbench::methods::manifold::manifold_segments_test
