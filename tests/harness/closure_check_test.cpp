/// What `correct` states about the closures that it used, dropped or did not check.
#include "harness/commands/correct/closure_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "datasets/derive/odometry.hpp"
#include "harness/commands/correct/correct.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/rounds.hpp"
#include "tests/support/simulated_drive.hpp"

namespace loopbench::test::closure_check_test {
namespace {

using namespace harness;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

CheckSentence of_consensus(const Problem& problem) {
  return sentence(check_closures(problem), problem, {.method = "consensus", .is_consensus = true});
}

CheckSentence of_pose_graph(const Problem& problem, std::vector<std::size_t> rejected = {}) {
  return sentence(
      check_closures(problem), problem, {.method = "pose_graph", .rejected = std::move(rejected)});
}

/// One of five closures is 8 m off.
Problem one_false() {
  Problem out = rounds(1);
  out.closures[2].from_from_to.translation += Vector3(8.0, 0.0, 0.0);
  return out;
}

/// A closure that contradicts a line of 40 m.
Problem contradicted_line() {
  Problem out = along_x({0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0});
  for (Edge& edge : out.odometry) edge.information = isotropic_information(4e-4, 4e-6);
  out.closures.push_back(
      {0, 8, turned_about_z(1.0, {2.0, 3.0, 0.0}), isotropic_information(4e-4, 4e-6)});
  return out;
}

TEST(ClosureCheck, StatesThatAllClosuresAgree) {
  const CheckSentence found = of_consensus(rounds(1));
  EXPECT_THAT(found.text, StartsWith("5 of 5 closures are used; estimated standard deviations: "));
  EXPECT_FALSE(found.is_warning);
  EXPECT_THAT(of_pose_graph(rounds(1)).text, HasSubstr("; they agree; "));
}

TEST(ClosureCheck, StatesThatASlipAtTheOnlyPlaceStaysUnnoticed) {
  Problem problem = rounds(1);
  EXPECT_THAT(of_consensus(problem).text, Not(HasSubstr("slip")));
  problem.closures.resize(1);
  const CheckSentence found = of_consensus(problem);
  EXPECT_THAT(found.text,
              StartsWith("1 of 1 closure is used; no other place predicts it, so a slip along the "
                         "path stays unnoticed; estimated"));
}

TEST(ClosureCheck, NamesAFalseClosureWithItsDistance) {
  const Problem problem = one_false();
  const CheckSentence found = of_consensus(problem);
  EXPECT_THAT(found.text, StartsWith("4 of 5 closures are used; dropped: 54.0 s -> 114.0 s ("));
  const std::string distance = found.text.substr(found.text.find('(') + 1);
  EXPECT_NEAR(std::atof(distance.c_str()), 8.0, 1.0);  // the drift of half a round
  EXPECT_THAT(found.text, HasSubstr(" m, "));
  EXPECT_FALSE(found.is_warning);
}

TEST(ClosureCheck, NamesWhatAnotherMethodUsedAndLost) {
  const CheckSentence used = of_pose_graph(one_false());
  EXPECT_TRUE(used.is_warning);
  EXPECT_THAT(used.text, StartsWith("5 of 5 closures are used by pose_graph; 1 of them disagrees"));
  EXPECT_THAT(used.text, HasSubstr("54.0 s -> 114.0 s ("));
  const CheckSentence lost = of_pose_graph(one_false(), {0, 2});
  EXPECT_FALSE(lost.is_warning);
  EXPECT_THAT(lost.text, HasSubstr("; 1 of those rejected agree with the others"));
}

TEST(ClosureCheck, StatesTheFactorOfTheRotationWhereItIsKnown) {
  Problem problem = simulated_drive({.closures = 30, .planar = false}).problem;
  for (Edge& edge : problem.odometry) edge.information *= 400.0;
  const ClosureCheck check = check_closures(problem);
  ASSERT_TRUE(check.is_decided());
  ASSERT_TRUE(check.judgement->factors.is_rotation_known);
  const std::string text = of_consensus(problem).text;
  const std::size_t at = text.find("rotation about ");
  ASSERT_NE(at, std::string::npos) << text;
  const double factor = std::atof(text.c_str() + at + 15);
  EXPECT_GT(factor, 10.0);
  EXPECT_LT(factor, 40.0);
  EXPECT_THAT(text, HasSubstr("times the stated one, translation larger than stated"));
}

TEST(ClosureCheck, MovesNothingWhereTheClosuresDoNotDecide) {
  const CheckSentence found = of_consensus(contradicted_line());
  EXPECT_TRUE(found.is_warning);
  EXPECT_THAT(found.text, StartsWith("the path is unchanged because "));
  EXPECT_THAT(found.text, HasSubstr("--trust-loops"));
  EXPECT_THAT(of_pose_graph(contradicted_line()).text, HasSubstr("is not decided"));
}

TEST(ClosureCheck, StatesWhatWasNotChecked) {
  Problem problem = circle();
  problem.closures.front().scale = 1.1;
  const CheckSentence found = of_pose_graph(problem);
  EXPECT_THAT(found.text, HasSubstr("were not checked: "));
  EXPECT_THAT(found.text, HasSubstr("change the scale"));
  EXPECT_THAT(found.text, Not(HasSubstr("use pose_graph")));
  EXPECT_EQ(json(check_closures(problem), problem)["checked"], false);
}

TEST(ClosureCheck, IsJson) {
  const Problem problem = one_false();
  const nlohmann::json out = json(check_closures(problem), problem);
  EXPECT_EQ(out["outcome"], "decided");
  EXPECT_EQ(out["agreeing"], 4);
  EXPECT_EQ(out["closures"][2]["from"], 54.0);
  EXPECT_NE(out["closures"][2]["finding"], "agrees");
  EXPECT_LT(out["closures"][2]["log_odds"], 0.0);
}

}  // namespace
}  // namespace loopbench::test::closure_check_test
