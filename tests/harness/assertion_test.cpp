/// Assertions about the comparison of a sweep that is worked by hand.
#include "harness/answers/compare/assertion.hpp"

#include <gtest/gtest.h>

#include "tests/support/compared_sweep.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::compared_sweep::assertion_test {
namespace {

/// The sentence about an assertion that the comparison does not show, after the assertion itself;
/// empty if it shows it.
std::string why(const std::string& text, const std::vector<Record>& records = sweep()) {
  const std::vector<std::string> out =
      not_shown({text}, compared(records), [&](const std::string& baseline) {
        return compared(records, {.baseline = baseline});
      });
  if (out.empty()) return "";
  const std::string begin = "assertion not shown: " + text + ": ";
  EXPECT_EQ(out.at(0).find(begin), 0u) << out.at(0);
  return out.at(0).substr(begin.size());
}

// dual / uniform: eight logarithms, whose third means from either end are log 0.84 and log 0.89:
// the interval at 1 - sqrt(0.95), because copy is uniform and raw is another test.
TEST(Assertion, OfAPercentageIsDecidedByTheEndOfTheInterval) {
  EXPECT_EQ(why("dual is below uniform"), "");
  EXPECT_EQ(why("dual is at least 10 % below uniform"), "");
  EXPECT_EQ(why("dual is at least 12 % below uniform"),
            "measured 14 % below uniform (95 %: 11 to 16), p = 0.016; over 8 runs of 2 sequences");
  EXPECT_EQ(why("raw is at most 100.1 % above uniform"), "");  // twice the error on each run
  EXPECT_EQ(
      why("raw is at most 99.9 % above uniform"),
      "measured 100 % above uniform (95 %: 100 to 100), p = 0.016; over 8 runs of 2 sequences");
  EXPECT_EQ(why("copy is at most 0.1 % above uniform"), "");
  EXPECT_EQ(why("dual is at most 1 % above uniform"), "");
}

TEST(Assertion, IsDecidedByTheTestWithoutAPercentage) {
  EXPECT_EQ(why("dual is not above uniform"), "");
  EXPECT_EQ(why("copy is not above uniform"), "");
  EXPECT_EQ(why("copy is not shown to differ from uniform"), "");
  for (const char* text : {"raw is not above uniform",
                           "raw is below uniform",
                           "copy is below uniform",
                           "dual is not shown to differ from uniform",
                           "raw is not shown to differ from uniform"}) {
    EXPECT_NE(why(text), "") << text;
  }
}

TEST(Assertion, HasTheComparisonWithItsSecondMethod) {
  EXPECT_EQ(why("dual is at least 55 % below raw"), "");  // 0.45 to 0.415
  EXPECT_EQ(why("dual is at least 56 % below raw"),
            "measured 57 % below raw (95 %: 55 to 58), p = 0.016; over 8 runs of 2 sequences");
  EXPECT_EQ(why("uniform is not shown to differ from copy"), "");
  EXPECT_NE(why("raw is at most 100.1 % above dual"), "");
}

TEST(Assertion, HasNoOrderFromTooFewRuns) {
  std::vector<Record> few = sweep();
  std::erase_if(few, [](const Record& r) { return r.cell->sequence == "city"; });
  EXPECT_EQ(why("dual is below uniform", few),
            "measured 12 % below uniform; 4 runs of 1 sequence; a test needs 7");
  EXPECT_NE(why("dual is at most 50 % above uniform", few), "");  // no interval
  EXPECT_EQ(why("raw is not above uniform", few), "");
}

TEST(Assertion, ComparesValuesOfWhichHigherOnesAreBetter) {
  std::vector<Record> records = sweep();
  for (Record& r : records) r.kind.edit().better = Better::higher;
  EXPECT_EQ(why("dual is at least 10 % below uniform", records), "");
  EXPECT_EQ(
      why("raw is not above uniform", records),
      "measured 100 % above uniform (95 %: 100 to 100), p = 0.016; over 8 runs of 2 sequences; "
      "above and below compare values, of which higher ones are better");
  for (Record& r : records) {
    r.kind.edit().better = Better::target;
    r.kind.edit().target = 1.0;
  }
  EXPECT_NE(refusal_of([&] {
              why("dual is below uniform", records);
            }).find("the best value of ate is 1, so that neither above nor below is better"),
            std::string::npos);
}

TEST(Assertion, ShowsNothingWithoutCommonRunsAndNoOrderOfAPart) {
  std::vector<Record> records = sweep();
  for (int i = 0; i < 8; ++i) {
    records.push_back(failed(i < 4 ? "room" : "city", i % 4, "broken"));
    records.push_back(score(i < 4 ? "room" : "city", i % 4, "part", i < 4 ? 0.02 : 20.0));
    records.back().pairs = 50;
    records.back().possible = 100;
  }
  EXPECT_EQ(why("broken is not shown to differ from dual", records),
            "broken has no value on any run");
  EXPECT_EQ(why("dual is not above broken", records),
            "the baseline broken has no value on any run: nothing is compared");
  EXPECT_EQ(why("part is below uniform", records),
            "part covers 50 % of the reference, others up to 100 %");
  EXPECT_EQ(why("dual is below uniform", records), "");
}

TEST(Assertion, IsOneOfFiveSentences) {
  const std::string quoted = "dual + dm (turn_max=0.2) is at least 1.5 % below a is b";
  EXPECT_TRUE(
      refusal_of([&] {
        why(quoted);
      }).starts_with("--assert: '" + quoted + "': no method is named 'dual + dm (turn_max=0.2)'"));
  EXPECT_TRUE(has(refusal_of([] { why("dual is at least 1.5 % below a is b"); }),
                  "no method is named 'a is b'"));
  for (const std::string text : {"dual is 15 % below raw",
                                 "dual is at least 15 % above raw",
                                 "dual is at least -1 % below raw",
                                 "dual is at most nan % above raw",
                                 "dual is below ",
                                 " is below raw",
                                 ""}) {
    EXPECT_EQ(refusal_of([&] { why(text); }),
              "--assert: expected 'A is below B', 'A is at least X % below B', 'A is not above B', "
              "'A is at most X % above B' or 'A is not shown to differ from B', found '" +
                  text + "'");
  }
  EXPECT_TRUE(
      has(refusal_of([] { why(std::string(1'000'000, 'a')); }), "--assert: expected 'A is "));
}

}  // namespace
}  // namespace loopbench::compared_sweep::assertion_test
