#include "metrics/pairing/pair_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace loopbench::pair_search_test {

using namespace metrics;

namespace {

using Pairs = std::vector<FromTo>;

/// Literal copy of evo's filters.py: argmin over all later poses.
Pairs literal(const std::vector<double>& measure, double delta, double tolerance) {
  Pairs out;
  for (std::size_t i = 0; i + 1 < measure.size(); ++i) {
    const auto miss = [&](std::size_t j) { return std::abs((measure[j] - measure[i]) - delta); };
    std::size_t best = i + 1;
    for (std::size_t j = i + 2; j < measure.size(); ++j) {
      if (miss(j) < miss(best)) best = j;
    }
    if (miss(best) <= tolerance) out.emplace_back(i, best);
  }
  return out;
}

TEST(PairSearch, FramesCountOn) {
  EXPECT_EQ(pairs_by_frames(5, 3), (Pairs{{0, 3}, {1, 4}}));
  EXPECT_TRUE(pairs_by_frames(3, 3).empty());
  EXPECT_TRUE(pairs_by_frames(0, 1).empty());
}

TEST(PairSearch, TakesTheNearestLaterPose) {
  // From 0: 0.9 and 1.1 are equally near to 1, the first wins.
  EXPECT_EQ(pairs_by_measure({0.0, 0.875, 1.125}, 1.0, 0.2), (Pairs{{0, 1}}));
  EXPECT_EQ(pairs_by_measure({0.0, 0.8, 1.1}, 1.0, 0.15), (Pairs{{0, 2}}));
  EXPECT_TRUE(pairs_by_measure({0.0, 0.5}, 1.0, 0.4).empty());
  EXPECT_TRUE(pairs_by_measure({}, 1.0, 0.4).empty());
  EXPECT_TRUE(pairs_by_measure({3.0}, 1.0, 0.4).empty());
}

TEST(PairSearch, MissOfExactlyTheToleranceCounts) {
  EXPECT_EQ(pairs_by_measure({0.0, 1.25}, 1.0, 0.25).size(), 1u);
}

TEST(PairSearch, IsTheLiteralRuleOnRandomMeasuresWithStandstills) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 3000; ++round) {
    const int size = std::uniform_int_distribution<int>(0, 40)(random);
    std::vector<double> measure;
    double value = 0.0;
    for (int i = 0; i < size; ++i) {
      measure.push_back(value);
      value += std::max(0, std::uniform_int_distribution<int>(-4, 6)(random)) / 16.0;
    }
    const double delta = std::uniform_int_distribution<int>(1, 40)(random) / 16.0;
    const double tolerance = std::uniform_int_distribution<int>(0, 10)(random) / 16.0;
    ASSERT_EQ(pairs_by_measure(measure, delta, tolerance), literal(measure, delta, tolerance))
        << "round " << round;
  }
}

TEST(PairSearch, LongStandstillsAreNotQuadratic) {
  // Half a million poses at 0 m, half a million at 0.95 m: the second run is a candidate of each
  // start.
  std::vector<double> measure(1'000'000, 0.0);
  for (std::size_t i = 500'000; i < measure.size(); ++i) measure[i] = 0.95;
  const Pairs got = pairs_by_measure(measure, 1.0, 0.1);
  ASSERT_EQ(got.size(), 500'000u);
  EXPECT_EQ(got.back(), (FromTo{499'999, 500'000}));
}

TEST(PairSearch, DistancesAccumulate) {
  Trajectory corner(3);
  corner[1].world_from_body.translation = {3, 4, 0};
  corner[2].world_from_body.translation = {3, 4, 2};
  EXPECT_EQ(accumulated_distances(corner), (std::vector<double>{0, 5, 7}));
}

}  // namespace
}  // namespace loopbench::pair_search_test
