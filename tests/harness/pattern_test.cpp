#include "harness/sweep/text/pattern.hpp"

#include <gtest/gtest.h>

#include "datasets/core/error.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::pattern_test {

using namespace harness;

namespace {

std::string refusal(const std::string& expression) {
  return refusal_of<InputError>([&] { Pattern{expression}; });
}

TEST(Pattern, IsFoundAnywhereOrHasToBeAllOfTheText) {
  const Pattern chains("KITTI 0[67]");
  EXPECT_TRUE(chains.matches_part("held out: KITTI 07 loam"));
  EXPECT_FALSE(chains.matches_part("KITTI 00 loam"));
  EXPECT_FALSE(chains.matches("held out: KITTI 07 loam"));
  EXPECT_TRUE(chains.matches("KITTI 06"));
  EXPECT_TRUE(Pattern("").matches_part("anything"));
  EXPECT_TRUE(Pattern("KITTI .*(loam|imls)").matches("KITTI 06 imls"));
}

TEST(Pattern, BracketsOfTheTextAreTextWhenEscaped) {
  EXPECT_TRUE(Pattern(R"(^evo \(align=se3\)$)").matches_part("evo (align=se3)"));
}

TEST(Pattern, RefusesInWordsWhatIsNoExpression) {
  EXPECT_EQ(refusal("("), "'(' is not a regular expression (missing ): ()");
  EXPECT_EQ(refusal("a{99999999999}"), "");  // not a repetition: literal braces
  EXPECT_EQ(refusal("a{1001}"),
            "'a{1001}' is not a regular expression (invalid repetition size: {1001})");
  EXPECT_EQ(refusal("\\99999999999"),
            "'\\99999999999' is not a regular expression (invalid escape sequence: \\9)");
  EXPECT_EQ(refusal("(?!a)"), "'(?!a)' is not a regular expression (invalid perl operator: (?!)");
  EXPECT_EQ(refusal(std::string(1'001, 'a')), "the pattern is longer than 1000 characters");
  EXPECT_EQ(refusal("\xff"), "'\xff' is not a regular expression (invalid UTF-8)");
  EXPECT_EQ(refusal_of<InputError>([] { Pattern::of_option("--only", "["); }),
            "--only: '[' is not a regular expression (missing ]: [)");
}

TEST(Pattern, NeitherNestingNorRepetitionRunsAway) {
  // Each of these costs a backtracking matcher exponential time, or its stack.
  EXPECT_FALSE(Pattern("(a+)+$").matches_part(std::string(100'000, 'a') + "b"));
  EXPECT_FALSE(Pattern("(a|aa)*c").matches_part(std::string(100'000, 'a')));
  EXPECT_NE(refusal("((((a{100}){100}){100}){100})"), "");
  EXPECT_TRUE(Pattern(std::string(499, '(') + "a" + std::string(499, ')')).matches_part("a"));
}

}  // namespace
}  // namespace loopbench::pattern_test
