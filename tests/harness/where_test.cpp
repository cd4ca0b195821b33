/// Filter rules and lists, with labels that contain commas.
#include "harness/model/where.hpp"

#include <gtest/gtest.h>

#include "tests/support/refusal_of.hpp"

namespace loopbench::where_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

bool keeps(const std::string& rule, const std::string& method) {
  Record record;
  record.kind.edit().metric = "ate";
  record.cell.edit().method = method;
  return where({rule})(record);
}

TEST(Where, SelectsLabelsWithCommas) {
  EXPECT_TRUE(keeps("method=\"a, b=2\"", "a, b=2"));
  EXPECT_FALSE(keeps("method=\"a, b=2\"", "a"));
  EXPECT_TRUE(keeps("method!=\"a, b\",metric=ate", "a"));
  EXPECT_FALSE(keeps("method!=\"a, b\",metric=ate", "a, b"));
  EXPECT_TRUE(keeps("method~\"a, b\"", "x a, b y"));
  EXPECT_TRUE(keeps("metric=ate,method=\"a, b\"", "a, b"));
  EXPECT_TRUE(keeps("method=5\" wheel", "5\" wheel"));  // a quote inside a text is literal
  EXPECT_TRUE(keeps("method=dm (x=1, y=2)", "dm (x=1, y=2)"));
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
}  // namespace loopbench::where_test
