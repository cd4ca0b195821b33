// A closure that is listed twice is one measurement for the judgement.
#include "methods/correctors/consensus/repeated_closures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "datasets/derive/odometry.hpp"
#include "methods/correctors/consensus/judgement.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/simulated_drive.hpp"

namespace loopbench::test::repeated_closures_test {
namespace {

using namespace methods;
using testing::ElementsAre;

/// 40 steps of 1 m, and closures that are 3 m off and turned by a radian.
Problem off(std::size_t closures) {
  std::vector<double> x(41);
  std::iota(x.begin(), x.end(), 0.0);
  Problem out = along_x(x);
  for (Edge& edge : out.odometry) edge.information = isotropic_information(4e-4, 4e-6);
  const Edge closure{
      0, 40, turned_about_z(1.0, {2.0, 3.0, 0.0}), isotropic_information(4e-4, 4e-6)};
  out.closures.assign(closures, closure);
  return out;
}

TEST(RepeatedClosures, AreEqualToSixDigits) {
  Problem problem = off(3);
  problem.closures[1].from_from_to.translation[0] += 1e-6;
  problem.closures[2].from_from_to.translation[0] += 1e-3;
  EXPECT_THAT(consensus::repeated_closures(problem), ElementsAre(0u, 0u, 2u));
}

TEST(RepeatedClosures, DoNotConfirmEachOther) {
  for (const std::size_t count : {1u, 2u, 3u}) {
    const ClosureJudgement found = judge_closures(off(count));
    EXPECT_FALSE(found.is_decided()) << count;
    EXPECT_EQ(found.agreeing, 0u) << count;
  }
}

TEST(RepeatedClosures, HaveTheJudgementOfTheFirst) {
  Problem problem = simulated_drive({.closures = 8, .false_share = 0.25}).problem;
  const ClosureJudgement once = judge_closures(problem);
  std::vector<Edge> twice;
  for (const Edge& edge : problem.closures) twice.insert(twice.end(), 2, edge);
  problem.closures = twice;
  const ClosureJudgement found = judge_closures(problem);
  EXPECT_EQ(found.agreeing, 2 * once.agreeing);
  EXPECT_EQ(found.evidence, once.evidence);
  for (std::size_t k = 0; k < twice.size(); ++k) {
    EXPECT_EQ(found.closures[k].finding, once.closures[k / 2].finding) << k;
  }
}

}  // namespace
}  // namespace loopbench::test::repeated_closures_test
