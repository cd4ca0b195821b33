/// Row filters (--where) and lists of words.
#include "harness/sweep/model/where.hpp"

#include <gtest/gtest.h>

#include "tests/support/compared_sweep.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::compared_sweep::where_test {
namespace {

TEST(Where, KeepsWhatEveryRuleKeeps) {
  const auto keeps = [](const std::string& rule) { return where({rule})(ate("dm_n3", 1.0)); };
  EXPECT_TRUE(keeps("metric=ate"));
  EXPECT_FALSE(keeps("metric=rpe"));
  EXPECT_TRUE(keeps("metric!=rpe"));
  EXPECT_FALSE(keeps("metric!=ate"));
  const auto keeps_labelled = [](const std::string& rule) {
    Record r = ate("raw", 1.0);
    r.kind.edit().label = "error";
    return where({rule})(r);
  };
  EXPECT_TRUE(keeps_labelled("metric=ate"));  // name and label
  EXPECT_TRUE(keeps_labelled("metric=error"));
  EXPECT_TRUE(keeps_labelled("metric~^err"));
  EXPECT_FALSE(keeps_labelled("metric!=ate"));
  EXPECT_FALSE(keeps_labelled("metric!=error"));
  EXPECT_TRUE(keeps_labelled("label=error"));
  EXPECT_FALSE(keeps_labelled("label=ate"));
  EXPECT_TRUE(keeps("method~^dm_.[0-9]$"));
  EXPECT_FALSE(keeps("method~^raw"));
  EXPECT_TRUE(keeps("metric=ate,method~dm,times=dense"));
  EXPECT_FALSE(keeps("metric=ate,times=keyframes"));
  EXPECT_TRUE(keeps("protocol=evo (align=se3, first=10),metric=ate"));  // commas in brackets
  EXPECT_TRUE(keeps("method~^dm_n{1,2}3"));
  EXPECT_FALSE(where({"metric=ate", "times=keyframes"})(ate("raw", 1.0)));
  EXPECT_TRUE(where({})(ate("raw", 1.0)));
}

TEST(Where, KeepsTheReasonsOfCellsWithoutScores) {
  Record failed;
  failed.cell.edit().method = "raw";
  failed.status = Status::failed;
  EXPECT_TRUE(where({"metric=ate"})(failed));
  EXPECT_FALSE(where({"method=dm"})(failed));
  EXPECT_FALSE(where({"status=ok"})(failed));
}

TEST(Where, RefusesByName) {
  EXPECT_EQ(
      refusal_of([] { where({"ate"}); }),
      "where: 'ate': expected FIELD=TEXT, FIELD!=TEXT or FIELD~REGEX, for example metric=ate or "
      "method=\"a, b\"");
  EXPECT_EQ(refusal_of([] { where({"method~("}); }),
            "where: 'method~(': '(' is not a regular expression (missing ): ()");
  EXPECT_NE(refusal_of([] { where({"metric=ate,"}); }), "");
  EXPECT_NE(refusal_of([] { where({"metric!ate"}); }), "");
}

bool keeps_method(const std::string& rule, const std::string& method) {
  Record record;
  record.kind.edit().metric = "ate";
  record.cell.edit().method = method;
  return where({rule})(record);
}

TEST(Where, SelectsLabelsWithCommas) {
  EXPECT_TRUE(keeps_method("method=\"a, b=2\"", "a, b=2"));
  EXPECT_FALSE(keeps_method("method=\"a, b=2\"", "a"));
  EXPECT_TRUE(keeps_method("method!=\"a, b\",metric=ate", "a"));
  EXPECT_FALSE(keeps_method("method!=\"a, b\",metric=ate", "a, b"));
  EXPECT_TRUE(keeps_method("method~\"a, b\"", "x a, b y"));
  EXPECT_TRUE(keeps_method("metric=ate,method=\"a, b\"", "a, b"));
  EXPECT_TRUE(keeps_method("method=5\" wheel", "5\" wheel"));  // a quote inside a text is literal
  EXPECT_TRUE(keeps_method("method=dm (x=1, y=2)", "dm (x=1, y=2)"));
}

TEST(Where, NamesAQuoteThatIsNotClosed) {
  EXPECT_EQ(refusal_of([] { where({"method=\"a, b"}); }), "'method=\"a, b': missing closing quote");
}

TEST(SplitList, KeepsWhatBracketsAndQuotesHold) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(split_list("a,b"), (Words{"a", "b"}));
  EXPECT_EQ(split_list("dm (x=1, y=2),raw"), (Words{"dm (x=1, y=2)", "raw"}));
  EXPECT_EQ(split_list("\"a, b\",c"), (Words{"a, b", "c"}));
}

}  // namespace
}  // namespace loopbench::compared_sweep::where_test
