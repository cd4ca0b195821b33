#include <gtest/gtest.h>

#include "manifold_paths.hpp"
#include "methods/smoothers/manifold/quasi_keyframes.hpp"
#include "methods/smoothers/manifold/segments.hpp"
#include "methods/smoothers/manifold/windows.hpp"

namespace loopbench::methods::manifold::manifold_windows_test {
namespace {

using Ranges = std::vector<NodeRange>;
using Windows = std::vector<Window>;

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
}  // namespace loopbench::methods::manifold::manifold_windows_test
