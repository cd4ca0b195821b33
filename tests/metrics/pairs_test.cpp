#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "metrics/errors/rpe.hpp"
#include "metrics/pairing/pair_search.hpp"
#include "metrics/pairing/tum_motions.hpp"
#include "metrics/protocols/protocols.hpp"
#include "support.hpp"

namespace loopbench::test::pairs_test {
namespace {

using Pairs = std::vector<FromTo>;

using Json = nlohmann::json;

const Json& sampled() {
  static const Json all = [] {
    std::ifstream file(std::string(LOOPBENCH_TEST_DATA) + "/tum_sampled/sampled.json");
    return Json::parse(file);
  }();
  return all;
}

Trajectory turning(const std::vector<double>& yaws) {
  Trajectory out;
  for (const double yaw : yaws) {
    const double n = static_cast<double>(out.size());
    out.push_back({n, {exp_so3(Vector3(0.0, 0.0, yaw)), Vector3(n, 0.0, 0.0)}});
  }
  return out;
}

TEST(Consecutive, PairsOfFramesAreAdjacent) {
  EXPECT_EQ(consecutive_frames(8, 3), (Pairs{{0, 3}, {3, 6}}));
  EXPECT_EQ(consecutive_frames(3, 3), Pairs{});
}

TEST(Consecutive, MetresLeaveTheFirstPoseOutAndAnglesDoNot) {
  // Sums 0, 1, 2 | 1, 2 | 1, 2: cuts at 2, 4 and 6.
  const std::vector<double> steps{0, 1, 1, 1, 1, 1, 1, 1};
  EXPECT_EQ(consecutive_by_measure(steps, 2.0, FirstPose::left_out), (Pairs{{2, 4}, {4, 6}}));
  EXPECT_EQ(consecutive_by_measure(steps, 2.0, FirstPose::starts), (Pairs{{0, 2}, {2, 4}, {4, 6}}));
  EXPECT_EQ(consecutive_by_measure({}, 2.0, FirstPose::starts), Pairs{});
}

TEST(Consecutive, SecondsMissByNoMoreThanTheTolerance) {
  EXPECT_EQ(consecutive_seconds({0, 1, 2, 3, 4, 5}, 2.0, 0.2), (Pairs{{0, 2}, {2, 4}}));
  // 15 Hz: 0.1 s lies between one step and two, and neither is within 10 % of it.
  std::vector<double> stamps;
  for (int i = 0; i < 30; ++i) stamps.push_back(i / 15.0);
  EXPECT_EQ(consecutive_seconds(stamps, 0.1, 0.01), Pairs{});
  // 10 Hz with the rounding of large stamps, and a gap that no pair crosses.
  stamps.clear();
  for (int i = 0; i < 30; ++i) {
    if (i < 10 || i >= 15) stamps.push_back(1.7e9 + 0.1 * i);
  }
  const Pairs got = consecutive_seconds(stamps, 0.1, 0.01);
  EXPECT_EQ(got.size(), 9u + 14u);
  for (const auto& [i, j] : got) EXPECT_EQ(j, i + 1);
  EXPECT_EQ(consecutive_seconds({}, 1.0, 0.1), Pairs{});
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
  // Five: the middle, 2, is probed first and is as near to 1.5 as 1 is.
  EXPECT_EQ(tum_closest_index({0, 1, 2, 3, 4}, 1.5), 2u);
  // Four: again 2 first; 1, probed later, is as near, not nearer.
  EXPECT_EQ(tum_closest_index({0, 1, 2, 3}, 1.5), 2u);
  EXPECT_EQ(tum_closest_index({0, 1, 2, 3}, 2.5), 2u);
  EXPECT_EQ(tum_closest_index({0, 1, 2, 3}, 9.0), 3u);
  EXPECT_EQ(tum_closest_index({0, 1, 2, 3}, -9.0), 0u);
  EXPECT_EQ(tum_closest_index({5}, 1.0), 0u);
}

constexpr std::size_t kMostPairs = 10'000;

/// Their pairs by stamp: integer seconds, one per pose of turning().
Pairs of_complete_estimate(const TumMotions& motions) {
  Pairs out;
  const auto number = [&](std::size_t i) {
    return static_cast<std::size_t>(motions.poses.estimate[i].stamp);
  };
  for (const auto& [i, j] : motions.pairs) out.emplace_back(number(i), number(j));
  return out;
}

TEST(TumMotions, DropTheLastPoseAsAnEndAndGapsInTheReference) {
  Trajectory reference = turning({0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  const Trajectory estimate = reference;
  const PairDelta one{1.0, DeltaUnit::s, 0.1};
  // 8 -> 9 and 9 -> 9 end in the last pose.
  const auto motions = [&] { return tum_motions({reference, estimate}, 0.0, {}, one, kMostPairs); };
  EXPECT_EQ(motions().pairs.size(), 8u);
  // Without 3..7 the median stays 1 s, and 5 s is 3 s from its neighbours: beyond 2.
  reference.erase(reference.begin() + 3, reference.begin() + 8);
  EXPECT_EQ(of_complete_estimate(motions()),
            (Pairs{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {6, 7}, {7, 8}}));
  EXPECT_EQ(motions().poses.reference.size(), 8u);  // 5 and 9 are not used
}

TEST(TumMotions, MeasureMetresFramesAndTurns) {
  const Trajectory poses = turning({0.0, 0.4, 0.8, 1.2, 1.6, 2.0});
  const auto pairs = [&](double delta, DeltaUnit unit) {
    return of_complete_estimate(
        tum_motions({poses, poses}, 0.0, {}, {delta, unit, 0.1}, kMostPairs));
  };
  const Pairs two{{0, 2}, {1, 3}, {2, 4}};
  EXPECT_EQ(pairs(2.0, DeltaUnit::frames), two);
  EXPECT_EQ(pairs(2.1, DeltaUnit::m), two);
  EXPECT_EQ(pairs(0.81, DeltaUnit::rad), two);
  EXPECT_EQ(pairs(46.0, DeltaUnit::deg), two);
}

/// Python 3.11: random.seed(0); [random.randint(0, SIZE - 1) for _ in range(8)].
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

/// Result of Python's random.sample and the rules of evaluate_rpe.py in tests/data/tum_sampled.
TEST(PythonRandom, SamplesWhatPythonSamples) {
  for (const Json& wanted : sampled()["sample"]) {
    const std::vector<std::size_t> got =
        PythonRandom().sample(wanted["size"].get<std::size_t>(), wanted["count"]);
    ASSERT_EQ(got.size(), wanted["count"].get<std::size_t>());
    const auto shown = static_cast<std::ptrdiff_t>(wanted["first"].size());
    using List = std::vector<std::size_t>;
    EXPECT_EQ(List(got.begin(), got.begin() + shown), wanted["first"].get<List>()) << wanted;
    EXPECT_EQ(List(got.end() - shown, got.end()), wanted["last"].get<List>()) << wanted;
    EXPECT_EQ(std::accumulate(got.begin(), got.end(), std::size_t{0}), wanted["sum"]) << wanted;
  }
}

/// The trajectories of make.py.
StampedPose spiral(double t, double shift, double wobble) {
  const double yaw = 0.7 * std::sin(0.05 * t) + wobble * std::sin(3.0 * t);
  return {t,
          {exp_so3(Vector3(0.0, 0.0, yaw)),
           Vector3(0.02 * t * std::cos(0.01 * t) + shift * std::sin(2.0 * t),
                   0.02 * t * std::sin(0.01 * t) + shift * std::cos(1.7 * t),
                   0.5 * std::sin(0.03 * t) + shift * std::sin(2.9 * t))}};
}

TEST(TumMotions, OfMoreThanMaxPairsAreThoseThatTheToolDraws) {
  Trajectory reference;
  Trajectory estimate;
  for (int i = 0; i < 10'500; ++i) estimate.push_back(spiral(0.05 * i, 0.03, 0.02));
  for (int i = 0; i < 13'200; ++i) {
    const double t = 0.04 * i + 0.003;
    if (t <= 100.0 || t >= 103.0) reference.push_back(spiral(t, 0.0, 0.0));
  }
  for (const Json& wanted : sampled()["rpe"]) {
    const Protocol rules =
        named_protocol("tum", {{"max_pairs", wanted["max_pairs"].get<std::int64_t>()}}).rules;
    const Evaluation evaluated = evaluate(reference, estimate, rules);
    RpeOptions options{.delta = wanted["delta"], .unit = DeltaUnit::s};
    const auto expect = [&](const Statistics& got, const Json& row) {
      ASSERT_EQ(got.count, row["n"].get<std::size_t>());
      for (const auto& [name, value] : {std::pair{"rmse", got.rmse},
                                        std::pair{"mean", got.mean},
                                        std::pair{"median", got.median},
                                        std::pair{"std", got.std},
                                        std::pair{"min", got.min},
                                        std::pair{"max", got.max}}) {
        EXPECT_NEAR(value, row[name].get<double>(), 1e-9) << name << " of " << wanted["delta"];
      }
    };
    expect(find(rpe(evaluated, options), "translation", "3d"), wanted["trans"]);
    options.relation = Relation::rotation_angle_rad;
    expect(rpe(evaluated, options).front().statistics, wanted["rot_rad"]);
  }
}

TEST(TumRandomMotions, TakeAllPairsOfFewerThanAHundredPoses) {
  Trajectory reference = turning({0, 0, 0, 0, 0, 0, 0, 0});
  const Trajectory estimate = turning({0, 0, 0});
  const auto pairs = [&](double offset) {
    return of_complete_estimate(tum_random_motions({reference, estimate}, offset, {}, kMostPairs));
  };
  EXPECT_EQ(pairs(0.0),
            (Pairs{{0, 0}, {0, 1}, {0, 2}, {1, 0}, {1, 1}, {1, 2}, {2, 0}, {2, 1}, {2, 2}}));
  // The reference starts 3 s after estimate pose 0: beyond twice its interval.
  EXPECT_EQ(pairs(-3.0), (Pairs{{1, 1}, {1, 2}, {2, 1}, {2, 2}}));
}

TEST(TumRandomMotions, DrawFromAHundredOn) {
  const Trajectory poses = turning(std::vector<double>(100, 0.0));
  const Pairs got = of_complete_estimate(tum_random_motions({poses, poses}, 0.0, {}, kMostPairs));
  ASSERT_EQ(got.size(), kMostPairs);
  EXPECT_EQ(got[0], (FromTo{49, 97}));
  EXPECT_EQ(got[1], (FromTo{53, 5}));
  const TumMotions few = tum_random_motions({poses, poses}, 0.0, {}, 7);
  EXPECT_EQ(of_complete_estimate(few), Pairs(got.begin(), got.begin() + 7));
}

TEST(SelectPairs, RejectsInvalidDeltas) {
  const Trajectory poses = turning({0.0, 1.0});
  const auto refusal = [&](double delta, DeltaUnit unit) {
    return why<OptionError>([&] { select_pairs(poses, poses, PairRule::all, {delta, unit, 0.1}); });
  };
  EXPECT_EQ(refusal(1.5, DeltaUnit::frames), "delta = 1.5: expected a whole number of frames");
  EXPECT_EQ(refusal(181.0, DeltaUnit::deg), "delta = 181.0: expected at most 180 degrees");
  EXPECT_EQ(refusal(4.0, DeltaUnit::rad), "delta = 4.0: expected at most 180 degrees");
}

}  // namespace
}  // namespace loopbench::test::pairs_test
