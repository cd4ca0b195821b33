#include "datasets/derive/revisits.hpp"

#include <gtest/gtest.h>

#include "tests/datasets/random_poses.hpp"

namespace loopbench::revisits_test {
namespace {

std::vector<Revisit> by_brute_force(const Trajectory& poses, const RevisitRule& rule) {
  std::vector<Revisit> out;
  for (std::size_t to = 0; to < poses.size(); ++to) {
    const Pose& current = poses[to].world_from_body;
    std::size_t best = to;
    double nearest = 0.0;
    for (std::size_t from = 0; from < to; ++from) {
      const Pose& earlier = poses[from].world_from_body;
      const double distance = (earlier.translation - current.translation).norm();
      if (poses[to].stamp - poses[from].stamp < rule.min_gap || distance > rule.radius) continue;
      if (angle_between(earlier.rotation, current.rotation) > rule.angle) continue;
      if (best != to && distance >= nearest) continue;
      best = from;
      nearest = distance;
    }
    if (best != to) out.push_back({best, to});
  }
  return out;
}

TEST(Revisits, EqualBruteForceOnRandomWalks) {
  std::size_t found = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Trajectory walk = random_walk(400, seed, 1.0, 0.4);
    for (const RevisitRule& rule : {RevisitRule{1.0, 0.8, 5.0}, RevisitRule{2.5, 3.2, 40.0}}) {
      const auto revisits = find_revisits(walk, rule);
      EXPECT_EQ(revisits, by_brute_force(walk, rule)) << "seed " << seed;
      found += revisits.size();
    }
  }
  EXPECT_GT(found, 500u);  // otherwise the comparison is not meaningful
}

TEST(Revisits, TakeTheEarliestOfEquallyNear) {
  const Trajectory still = on_a_line({0.0, 0.0, 0.0, 0.0});
  EXPECT_EQ(find_revisits(still, {0.1, 0.1, 2.0}), (std::vector<Revisit>{{0, 2}, {0, 3}}));
}

TEST(Revisits, LookTheSameWay) {
  Trajectory there_and_back = on_a_line({0.0, 1.0, 0.0});
  there_and_back[2].world_from_body.rotation = exp_so3({0.0, 0.0, 3.0});
  EXPECT_TRUE(find_revisits(there_and_back, {0.5, 0.5, 1.0}).empty());
  EXPECT_EQ(find_revisits(there_and_back, {0.5, 3.1, 1.0}).size(), 1u);
}

TEST(Revisits, AreNotFoundInNothing) {
  EXPECT_TRUE(find_revisits({}, {}).empty());
  EXPECT_TRUE(find_revisits(on_a_line({0.0}), {}).empty());
}

TEST(Revisits, SpreadFromTheLongestLoop) {
  std::vector<double> stamps;
  for (int i = 0; i <= 100; ++i) stamps.push_back(i);
  // Many revisits along a repeated section, and one short loop far from it.
  const std::vector<Revisit> revisits = {{40, 50}, {0, 90}, {1, 91}, {2, 92}, {3, 93}, {10, 100}};
  EXPECT_EQ(subsample(revisits, stamps, 1), (std::vector<std::size_t>{1}));
  EXPECT_EQ(subsample(revisits, stamps, 2), (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(subsample(revisits, stamps, 3), (std::vector<std::size_t>{0, 1, 5}));
  EXPECT_EQ(subsample(revisits, stamps, 9).size(), 6u);
  EXPECT_TRUE(subsample(revisits, stamps, 0).empty());
}

TEST(Revisits, SpreadTakesEachOnceThoughEqual) {
  const std::vector<Revisit> equal = {{0, 1}, {0, 1}, {0, 1}};
  EXPECT_EQ(subsample(equal, {0.0, 1.0}, 2), (std::vector<std::size_t>{0, 1}));
}

TEST(Revisits, LingeringCostsNoMoreThanItsLatestPoses) {
  Trajectory still(20000);
  for (std::size_t i = 0; i < still.size(); ++i) still[i] = {static_cast<double>(i), Pose()};
  const std::vector<Revisit> revisits = find_revisits(still, {1.0, 1.0, 10.0});
  ASSERT_EQ(revisits.size(), still.size() - 10);
  for (const Revisit& r : revisits) EXPECT_GE(r.to - r.from, 10u);
}

}  // namespace
}  // namespace loopbench::revisits_test
