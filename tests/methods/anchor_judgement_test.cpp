// Anchors judged by each other and the odometry: outliers, and anchors that are shifted together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "datasets/derive/odometry.hpp"
#include "methods/correctors/closure_ledger.hpp"
#include "methods/correctors/consensus/anchor_text.hpp"

namespace loopbench::test::anchor_judgement_test {
namespace {

using namespace methods;
using methods::consensus::AnchorJudgement;
using ::testing::HasSubstr;

constexpr double kSigma = 0.5;         // of anchors [m]
const Vector3 kShift(0.0, 12.0, 0.0);  // of some of them

/// 120 poses 5 m apart on a winding path, or on a line, with an anchor at each third and some
/// closures.
Problem drive(std::uint64_t seed, bool is_straight = false, std::size_t closures = 0) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto noise = [&](double deviation) -> Vector3 {
    return deviation * Vector3(normal(random), normal(random), normal(random));
  };
  Problem out;
  Pose truth, estimate;
  std::vector<Pose> all;
  for (std::size_t k = 0; k < 120; ++k) {
    out.keyframes.push_back({static_cast<double>(k), estimate});
    all.push_back(truth);
    if (k > 0 && k % 3 == 0) {
      out.anchors.push_back({.keyframe = k,
                             .position = truth.translation + noise(kSigma),
                             .covariance = kSigma * kSigma * Matrix3::Identity()});
    }
    const double yaw = is_straight ? 0.0 : 0.12 * std::sin(static_cast<double>(k) / 9.0) + 0.05;
    const Pose step{exp_so3({0.0, 0.0, yaw}), {5.0, 0.0, 0.0}};
    const Pose measured = normalized(step * exp_se3(twist(noise(0.1), noise(0.01))));
    truth = normalized(truth * step);
    estimate = normalized(estimate * measured);
    if (k + 1 == 120) break;
    out.odometry.push_back({k, k + 1, measured, isotropic_information(0.01, 1e-4)});
  }
  for (std::size_t k = 0; k < closures; ++k) {
    const std::size_t from = 4 + 9 * k % 56, to = 62 + 13 * k % 56;
    const Pose motion = all[from].inverse() * all[to] * exp_se3(twist(noise(0.05), noise(0.005)));
    out.closures.push_back({from, to, normalized(motion), isotropic_information(0.0025, 2.5e-5)});
  }
  return out;
}

Problem shifted(Problem out, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i <= last; ++i) out.anchors[i].position += kShift;
  return out;
}

AnchorJudgement judged(const Problem& problem) {
  const ClosureLedger ledger = closure_ledger(problem);
  EXPECT_TRUE(ledger.rows.empty());
  EXPECT_EQ(ledger.verdict, LedgerVerdict::unknown);
  return ledger.anchors.value();
}

TEST(AnchorJudgement, WithoutClosuresAllAgreeOrTheOutliersAreNamed) {
  Problem problem = drive(1);
  AnchorJudgement found = judged(problem);
  EXPECT_EQ(found.agreeing, problem.anchors.size());
  EXPECT_FALSE(found.run);
  EXPECT_EQ(consensus::anchors_text(problem, found), "all 39 anchors agree");
  for (const std::size_t i : {5UL, 20UL}) problem.anchors[i].position += Vector3(12.0, -16.0, 0.0);
  found = judged(problem);
  for (std::size_t i = 0; i < problem.anchors.size(); ++i) {
    EXPECT_EQ(found.anchors[i].agrees, i != 5 && i != 20) << i;
  }
  EXPECT_NEAR(found.anchors[5].metres, 20.0, 2.5);
  EXPECT_FALSE(found.run);
}

// A street of reflections: ten anchors agree with each other. The ends of the run are as large as
// what is dropped; before, only these ends were.
TEST(AnchorJudgement, AnchorsThatAreShiftedTogetherAreDroppedTogether) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Problem problem = shifted(drive(seed), 15, 24);
    const AnchorJudgement found = judged(problem);
    ASSERT_TRUE(found.run) << seed;
    EXPECT_EQ(found.run->first, 15u);
    EXPECT_EQ(found.run->last, 24u);
    EXPECT_FALSE(found.run->is_end);
    EXPECT_NEAR(found.run->metres, 12.0, 2.5);
    for (std::size_t i = 0; i < problem.anchors.size(); ++i) {
      EXPECT_EQ(found.anchors[i].agrees, i < 15 || i > 24) << i;
    }
    EXPECT_THAT(consensus::anchors_text(problem, found),
                HasSubstr("10 from 48.0 s to 75.0 s that agree with each other"));
  }
}

// A shift of the last anchors is as likely as a wrong step of the odometry before them.
TEST(AnchorJudgement, AShiftThatDoesNotEndIsNotDecided) {
  const Problem problem = shifted(drive(1), 30, 38);
  const AnchorJudgement found = judged(problem);
  ASSERT_TRUE(found.run);
  EXPECT_TRUE(found.run->is_end);
  EXPECT_EQ(found.run->first, 30u);
  const std::string text = consensus::datum_shift_text(problem, found);
  EXPECT_THAT(text, HasSubstr("the anchors from 93.0 s on are shifted by 1"));
  EXPECT_THAT(text, HasSubstr("they or the odometry between 90.0 s and 93.0 s are wrong"));
}

// Closures show that the odometry is right.
TEST(AnchorJudgement, ClosuresDecideAboutAShiftThatDoesNotEnd) {
  const Problem problem = shifted(drive(1, false, 12), 30, 38);
  const AnchorJudgement found = closure_ledger(problem).anchors.value();
  EXPECT_FALSE(found.run && found.run->is_end);
  for (std::size_t i = 0; i < problem.anchors.size(); ++i) {
    EXPECT_EQ(found.anchors[i].agrees, i < 30) << i;
  }
}

TEST(AnchorJudgement, AShiftOfAnchorsOnALineIsStated) {
  Problem problem = drive(1, true);
  EXPECT_EQ(consensus::datum_shift_text(problem, judged(problem)), "");
  for (Anchor& anchor : problem.anchors) anchor.position += kShift;
  EXPECT_THAT(consensus::datum_shift_text(problem, judged(problem)),
              HasSubstr("cannot be told apart"));
}

}  // namespace
}  // namespace loopbench::test::anchor_judgement_test
