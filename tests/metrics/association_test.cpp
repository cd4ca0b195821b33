#include "metrics/pairing/association.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "support.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::test::association_test {
namespace {

using Pairs = std::vector<IndexPair>;
using Stamps = std::vector<double>;

/// Literal copy of evo's sync.py: argmin over all of the longer list.
Pairs literal_evo(Stamps reference, Stamps estimate, double max_diff, double offset) {
  const bool is_estimate_longer = estimate.size() > reference.size();
  Stamps& longer = is_estimate_longer ? estimate : reference;
  const Stamps& shorter = is_estimate_longer ? reference : estimate;
  for (double& stamp : longer) stamp += is_estimate_longer ? offset : -offset;
  Pairs out;
  for (std::size_t i = 0; i < shorter.size(); ++i) {
    std::size_t best = 0;
    for (std::size_t j = 1; j < longer.size(); ++j) {
      if (std::abs(longer[j] - shorter[i]) < std::abs(longer[best] - shorter[i])) best = j;
    }
    if (longer.empty() || std::abs(longer[best] - shorter[i]) > max_diff) continue;
    out.push_back(is_estimate_longer ? IndexPair{i, best} : IndexPair{best, i});
  }
  return out;
}

bool crosses(const IndexPair& a, const IndexPair& b) {
  return (a.reference < b.reference) != (a.estimate < b.estimate);
}

/// Literal copy of TUM's associate.py: all pairs, sorted, taken while both are free.
Pairs literal_one_to_one(const Stamps& reference,
                         const Stamps& estimate,
                         double max_diff,
                         Limit limit,
                         Crossing crossing,
                         double offset) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> candidates;
  for (std::size_t r = 0; r < reference.size(); ++r) {
    for (std::size_t e = 0; e < estimate.size(); ++e) {
      const double gap = std::abs(reference[r] - (estimate[e] + offset));
      if (limit == Limit::strict ? gap < max_diff : gap <= max_diff) {
        candidates.emplace_back(gap, r, e);
      }
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::set<std::size_t> references;
  std::set<std::size_t> estimates;
  Pairs out;
  for (const auto& [gap, r, e] : candidates) {
    if (references.contains(r) || estimates.contains(e)) continue;
    const IndexPair pair{r, e};
    const auto is_crossed = [&](const IndexPair& taken) { return crosses(taken, pair); };
    if (crossing == Crossing::refused && std::ranges::any_of(out, is_crossed)) continue;
    references.insert(r);
    estimates.insert(e);
    out.push_back({r, e});
  }
  std::sort(out.begin(), out.end(), [](const IndexPair& a, const IndexPair& b) {
    return a.reference < b.reference;
  });
  return out;
}

/// Strictly increasing multiples of 1/64 s, so that ties are exact and common; some in bursts.
Stamps random_stamps(std::mt19937_64& random, std::size_t most) {
  const std::size_t size = std::uniform_int_distribution<std::size_t>(0, most)(random);
  const int spread = std::uniform_int_distribution<int>(1, 12)(random);
  Stamps out;
  int ticks = std::uniform_int_distribution<int>(0, 30)(random);
  for (std::size_t i = 0; i < size; ++i) {
    const bool is_burst = std::uniform_int_distribution<int>(0, 3)(random) == 0;
    ticks += is_burst ? 1 : std::uniform_int_distribution<int>(1, spread)(random);
    out.push_back(ticks / 64.0);
  }
  return out;
}

TEST(Association, RulesAreTheLiteralOnesOnRandomStamps) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 3000; ++round) {
    const Stamps reference = random_stamps(random, 40);
    const Stamps estimate = random_stamps(random, 40);
    const double max_diff = std::uniform_int_distribution<int>(0, 20)(random) / 64.0;
    const double offset = std::uniform_int_distribution<int>(-20, 20)(random) / 64.0;
    ASSERT_EQ(match_evo(reference, estimate, max_diff, offset),
              literal_evo(reference, estimate, max_diff, offset))
        << "round " << round;
    for (const Limit limit : {Limit::strict, Limit::inclusive}) {
      for (const Crossing crossing : {Crossing::allowed, Crossing::refused}) {
        ASSERT_EQ(match_one_to_one(reference, estimate, max_diff, limit, crossing, offset),
                  literal_one_to_one(reference, estimate, max_diff, limit, crossing, offset))
            << "round " << round;
      }
    }
  }
}

TEST(Association, RulesAgreeWithTheLiteralOnesAtEpochStamps) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> step(0.001, 0.05);
  Stamps reference{1.7e9};
  Stamps estimate{1.7e9};
  for (int i = 0; i < 400; ++i) reference.push_back(reference.back() + step(random));
  for (int i = 0; i < 500; ++i) estimate.push_back(estimate.back() + step(random));
  for (const double offset : {0.0, -0.004, 0.0123}) {
    EXPECT_EQ(match_evo(reference, estimate, 0.01, offset),
              literal_evo(reference, estimate, 0.01, offset));
    EXPECT_EQ(match_evo(estimate, reference, 0.01, offset),
              literal_evo(estimate, reference, 0.01, offset));
    for (const Crossing crossing : {Crossing::allowed, Crossing::refused}) {
      EXPECT_EQ(match_one_to_one(reference, estimate, 0.02, Limit::strict, crossing, offset),
                literal_one_to_one(reference, estimate, 0.02, Limit::strict, crossing, offset));
    }
  }
}

TEST(Association, EvoMayUseOnePoseOfTheLongerListTwice) {
  const Pairs wanted{{1, 0}, {1, 1}};
  EXPECT_EQ(match_evo({0.0, 1.0, 2.0}, {0.75, 1.25}, 0.25, 0.0), wanted);
}

TEST(Association, EvoBreaksATieToTheFirst) {
  EXPECT_EQ(match_evo({0.0, 1.0, 2.0}, {0.5}, 1.0, 0.0), (Pairs{{0, 0}}));
}

TEST(Association, LimitsAreInclusiveForNearestAndStrictForTum) {
  EXPECT_EQ(match_evo({0.0}, {0.25}, 0.25, 0.0).size(), 1u);
  EXPECT_EQ(match_one_to_one({0.0}, {0.25}, 0.25, Limit::inclusive, Crossing::refused, 0.0).size(),
            1u);
  EXPECT_EQ(match_one_to_one({0.0}, {0.25}, 0.25, Limit::strict, Crossing::refused, 0.0).size(),
            0u);
}

TEST(Association, OffsetIsAddedToTheEstimate) {
  const Pairs wanted{{1, 0}};
  EXPECT_EQ(match_evo({0.0, 1.0}, {0.5}, 0.1, 0.5), wanted);
  EXPECT_EQ(match_one_to_one({0.0, 1.0}, {0.5}, 0.1, Limit::strict, Crossing::refused, 0.5),
            wanted);
}

TEST(Association, OneToOneTakesTheClosestFirst) {
  // 0.9 is nearer to 1.0 than 1.2 is; 1.2 remains for 2.0.
  const Pairs wanted{{0, 0}, {1, 1}};
  EXPECT_EQ(match_one_to_one({1.0, 2.0}, {0.9, 1.2}, 1.0, Limit::inclusive, Crossing::refused, 0.0),
            wanted);
  EXPECT_EQ(match_one_to_one({1.0, 2.0}, {0.9, 1.2}, 0.5, Limit::inclusive, Crossing::refused, 0.0),
            (Pairs{{0, 0}}));
}

TEST(Association, NearestRefusesPairsThatCrossWhereTumTakesThem) {
  // 2.005 and 2.004 are closest; 1.99 before them and 2.02 after them remain for each other.
  const Stamps reference{1.0, 1.99, 2.005, 3.0};
  const Stamps estimate{1.0, 2.004, 2.02, 3.0};
  const auto pairs = [&](Crossing crossing) {
    return match_one_to_one(reference, estimate, 0.05, Limit::inclusive, crossing, 0.0);
  };
  EXPECT_EQ(pairs(Crossing::allowed), (Pairs{{0, 0}, {1, 2}, {2, 1}, {3, 3}}));
  EXPECT_EQ(pairs(Crossing::refused), (Pairs{{0, 0}, {2, 1}, {3, 3}}));
}

TEST(Association, OneToOneIsFastWhateverTheLimit) {
  // All pairs would be 1e10. Worst case: each estimate lies halfway, so nothing is mutually
  // nearest.
  Stamps reference;
  Stamps estimate;
  for (int i = 0; i < 100'000; ++i) {
    reference.push_back(i);
    estimate.push_back(i + 0.5);
  }
  const Pairs got =
      match_one_to_one(reference, estimate, 1e9, Limit::inclusive, Crossing::refused, 0.0);
  ASSERT_EQ(got.size(), 100'000u);
  for (std::size_t i = 0; i < got.size(); ++i) ASSERT_EQ(got[i], (IndexPair{i, i}));
}

Trajectory line(const Stamps& stamps) {
  Trajectory out;
  for (const double stamp : stamps) {
    out.push_back({stamp, {exp_so3({0.0, 0.0, 0.1 * stamp}), {stamp, 0.0, 2.0 * stamp}}});
  }
  return out;
}

TEST(Association, InterpolatesTheReferenceAcrossSmallGapsOnly) {
  const Trajectory reference = line({0.0, 1.0, 2.0, 5.0, 6.0});
  // Outside, on a pose, between poses, in the gap, at the far edge of the gap, outside.
  const Trajectory estimate = line({-0.5, 0.0, 1.25, 3.0, 5.0, 6.5});
  const Paired got = interpolate_reference(reference, estimate, 1.0, 0.0);
  EXPECT_EQ(stamps(got.reference), (Stamps{0.0, 1.25, 5.0}));
  EXPECT_EQ(stamps(got.estimate), (Stamps{0.0, 1.25, 5.0}));
  for (std::size_t i = 0; i < got.reference.size(); ++i) {
    EXPECT_POSE_NEAR(
        got.reference[i].world_from_body, got.estimate[i].world_from_body, 1e-12, 1e-12);
  }
}

TEST(Association, InterpolationAddsTheOffset) {
  const Trajectory estimate = line({0.0, 1.0});
  const Paired got = interpolate_reference(line({0.0, 1.0}), estimate, 1.0, 0.25);
  ASSERT_EQ(got.reference.size(), 1u);
  EXPECT_EQ(got.reference[0].stamp, 0.25);
  EXPECT_EQ(got.estimate[0].stamp, 0.0);
  EXPECT_NEAR(got.reference[0].world_from_body.translation.x(), 0.25, 1e-15);
}

TEST(Association, NothingMatchesNothing) {
  for (const auto& [name, rule] : choices(Association{})) {
    const Protocol protocol{.association = rule};
    EXPECT_TRUE(associate({}, {}, protocol).reference.empty()) << name;
    EXPECT_TRUE(associate(line({0.0}), {}, protocol).reference.empty()) << name;
    EXPECT_TRUE(associate({}, line({0.0}), protocol).reference.empty()) << name;
    if (rule == Association::index) continue;  // ignores stamps
    EXPECT_TRUE(associate(line({0.0}), line({9.0}), protocol).reference.empty()) << name;
  }
}

TEST(Association, IndexPairsByNumberOrNotAtAll) {
  const Protocol protocol{.association = Association::index};
  const Paired got = associate(line({0.0, 1.0}), line({5.0, 9.0}), protocol);
  ASSERT_EQ(got.reference.size(), 2u);
  EXPECT_EQ(got.estimate[1].stamp, 9.0);
  EXPECT_THROW(associate(line({0.0, 1.0}), line({0.0}), protocol), std::runtime_error);
}

TEST(Association, EvoPairsBothPosesOfARepeatedStamp) {
  const Stamps longer{0.0, 1.0, 1.0, 2.0, 3.0, 3.0, 4.0}, shorter{0.999, 1.004, 1.004, 3.0, 3.005};
  const Pairs pairs = match_evo(longer, shorter, 0.01, 0.0);
  EXPECT_EQ(pairs, literal_evo(longer, shorter, 0.01, 0.0));
  EXPECT_EQ(pairs, (Pairs{{1, 0}, {1, 1}, {1, 2}, {4, 3}, {4, 4}}));
  EXPECT_EQ(match_evo(shorter, longer, 0.01, 0.0), literal_evo(shorter, longer, 0.01, 0.0));
}

}  // namespace
}  // namespace loopbench::test::association_test
