#include <gtest/gtest.h>

#include "metrics/pairs/angle_pairs.hpp"
#include "metrics/pairs/consecutive.hpp"
#include "metrics/pairs/python_random.hpp"
#include "metrics/pairs/tum_motions.hpp"
#include "support.hpp"

namespace loopbench::test {
namespace {

using Pairs = std::vector<FromTo>;

Trajectory turning(const std::vector<double>& yaws) {
  Trajectory out;
  for (const double yaw : yaws) {
    const double n = static_cast<double>(out.size());
    out.push_back({n, {exp_so3(Vector3(0.0, 0.0, yaw)), Vector3(n, 0.0, 0.0)}});
  }
  return out;
}

TEST(Consecutive, FramesGoOneStretchAfterTheOther) {
  EXPECT_EQ(consecutive_frames(8, 3), (Pairs{{0, 3}, {3, 6}}));
  EXPECT_EQ(consecutive_frames(3, 3), Pairs{});
}

TEST(Consecutive, MetresLeaveTheFirstPoseOutAndAnglesDoNot) {
  // Sums 0, 1, 2 | 1, 2 | 1, 2: cuts at 2, 4 and 6.
  const std::vector<double> steps{0, 1, 1, 1, 1, 1, 1, 1};
  EXPECT_EQ(consecutive_stretches(steps, 2.0, FirstPose::left_out), (Pairs{{2, 4}, {4, 6}}));
  EXPECT_EQ(consecutive_stretches(steps, 2.0, FirstPose::starts), (Pairs{{0, 2}, {2, 4}, {4, 6}}));
  EXPECT_EQ(consecutive_stretches({}, 2.0, FirstPose::starts), Pairs{});
}

TEST(AnglePairs, TakeEveryLaterPoseThatIsTurnedSoFar) {
  const Trajectory poses = turning({0.0, 0.5, 1.0, 0.5, 0.0});
  EXPECT_EQ(angle_pairs(poses, 1.0, 0.01), (Pairs{{0, 2}, {2, 4}}));
  EXPECT_EQ(angle_pairs(poses, 0.5, 0.01), (Pairs{{0, 1}, {0, 3}, {1, 2}, {1, 4}, {2, 3}, {3, 4}}));
  EXPECT_EQ(angle_pairs({}, 1.0, 0.1), Pairs{});
}

TEST(AnglePairs, AreThoseThatLookingAtAllOfThemFinds) {
  std::mt19937_64 random(3);
  const Trajectory poses = random_walk(random, 300);
  for (const double angle : {0.05, 0.5, 2.0, 3.1}) {
    Pairs wanted;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      for (std::size_t j = i + 1; j < poses.size(); ++j) {
        const double turned =
            angle_between(poses[i].world_from_body.rotation, poses[j].world_from_body.rotation);
        if (0.9 * angle <= turned && turned <= 1.1 * angle) wanted.emplace_back(i, j);
      }
    }
    EXPECT_EQ(angle_pairs(poses, angle, 0.1 * angle), wanted) << angle;
  }
}

TEST(TumClosestIndex, OnATieTheOneProbedFirstWins) {
  // Five: the middle, 2, is probed first, and equals 1 in distance to 1.5.
  EXPECT_EQ(tum_closest_index({0, 1, 2, 3, 4}, 1.5), 2u);
  // Four: again 2 first; a later 1 is as near, not nearer.
  EXPECT_EQ(tum_closest_index({0, 1, 2, 3}, 1.5), 2u);
  EXPECT_EQ(tum_closest_index({0, 1, 2, 3}, 2.5), 2u);
  EXPECT_EQ(tum_closest_index({0, 1, 2, 3}, 9.0), 3u);
  EXPECT_EQ(tum_closest_index({0, 1, 2, 3}, -9.0), 0u);
  EXPECT_EQ(tum_closest_index({5}, 1.0), 0u);
}

TEST(TumMotions, DropTheLastPoseAsAnEndAndGapsInTheReference) {
  Trajectory reference = turning({0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  const Trajectory estimate = reference;
  const Stretch one{1.0, DeltaUnit::s, 0.1};
  // 8 -> 9 and 9 -> 9 end in the last pose.
  EXPECT_EQ(tum_motions({reference, estimate}, 0.0, {}, one).pairs.size(), 8u);
  // Without 3..7 the median stays 1 s, and 5 s is 3 s from its neighbours: beyond 2.
  reference.erase(reference.begin() + 3, reference.begin() + 8);
  EXPECT_EQ(tum_motions({reference, estimate}, 0.0, {}, one).pairs,
            (Pairs{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {6, 7}, {7, 8}}));
}

TEST(TumMotions, MeasureMetresFramesAndTurns) {
  const Trajectory poses = turning({0.0, 0.4, 0.8, 1.2, 1.6, 2.0});
  const auto pairs = [&](double delta, DeltaUnit unit) {
    return tum_motions({poses, poses}, 0.0, {}, {delta, unit, 0.1}).pairs;
  };
  const Pairs two{{0, 2}, {1, 3}, {2, 4}};
  EXPECT_EQ(pairs(2.0, DeltaUnit::frames), two);
  EXPECT_EQ(pairs(2.1, DeltaUnit::m), two);
  EXPECT_EQ(pairs(0.81, DeltaUnit::rad), two);
  EXPECT_EQ(pairs(46.0, DeltaUnit::deg), two);
}

/// What Python 3.11 answers to random.seed(0); [random.randint(0, SIZE - 1) for _ in range(8)].
TEST(PythonRandom, DrawsWhatPythonDraws) {
  const auto draws = [](std::size_t size) {
    PythonRandom random;
    std::vector<std::size_t> out;
    for (int i = 0; i < 8; ++i) out.push_back(random.below(size));
    return out;
  };
  EXPECT_EQ(draws(657), (std::vector<std::size_t>{394, 430, 41, 265, 523, 497, 414, 310}));
  EXPECT_EQ(draws(100), (std::vector<std::size_t>{49, 97, 53, 5, 33, 65, 62, 51}));
  EXPECT_EQ(draws(1), std::vector<std::size_t>(8, 0));
}

TEST(TumRandomMotions, TakeAllPairsOfFewerThanAHundredPoses) {
  Trajectory reference = turning({0, 0, 0, 0, 0, 0, 0, 0});
  const Trajectory estimate = turning({0, 0, 0});
  EXPECT_EQ(tum_random_motions({reference, estimate}, 0.0, {}).pairs,
            (Pairs{{0, 0}, {0, 1}, {0, 2}, {1, 0}, {1, 1}, {1, 2}, {2, 0}, {2, 1}, {2, 2}}));
  // The reference starts 3 s after estimate pose 0: beyond twice its interval.
  EXPECT_EQ(tum_random_motions({reference, estimate}, -3.0, {}).pairs,
            (Pairs{{1, 1}, {1, 2}, {2, 1}, {2, 2}}));
}

TEST(TumRandomMotions, DrawFromAHundredOn) {
  const Trajectory poses = turning(std::vector<double>(100, 0.0));
  const Pairs got = tum_random_motions({poses, poses}, 0.0, {}).pairs;
  ASSERT_EQ(got.size(), 10'000u);
  EXPECT_EQ(got[0], (FromTo{49, 97}));
  EXPECT_EQ(got[1], (FromTo{53, 5}));
}

TEST(StretchPairs, RefuseWhatNoStretchCanBe) {
  const Trajectory poses = turning({0.0, 1.0});
  const auto refusal = [&](double delta, DeltaUnit unit) {
    return why<OptionError>([&] {
      stretch_pairs(poses, poses, PairRule::all, {delta, unit, 0.1});
    });
  };
  EXPECT_EQ(refusal(1.5, DeltaUnit::frames), "delta = 1.5: frames come whole");
  EXPECT_EQ(refusal(181.0, DeltaUnit::deg), "delta = 181.0: no turn is beyond half a circle");
  EXPECT_EQ(refusal(4.0, DeltaUnit::rad), "delta = 4.0: no turn is beyond half a circle");
}

}  // namespace
}  // namespace loopbench::test
