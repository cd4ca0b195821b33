/// Remarks of comparisons, and statistics that have none.
#include <gtest/gtest.h>

#include <algorithm>

#include "harness/compare/compare.hpp"
#include "tests/support/compared_sweep.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::compare_remarks_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

using namespace compared_sweep;  // NOLINT: its records are what every test here is about

bool has_remark(const Comparison& c, const std::string& part) {
  return std::ranges::any_of(remarks(c), [&](const std::string& remark) {
    return remark.find(part) != std::string::npos;
  });
}

TEST(Compare, RejectsStatisticsWithoutADirection) {
  for (const std::string value : {"count", "sse"}) {
    EXPECT_EQ(refusal_of([&] { compare(sweep(), {.baseline = "raw", .value = value}); }),
              "value: '" + value +
                  "' depends on the number of errors: no value is better than another; expected "
                  "rmse, mean, median, std, min or max");
  }
}

TEST(Compare, StatesThatPIsTheLargerOfTwo) {
  EXPECT_TRUE(
      has_remark(compared(sweep()),
                 "p is the larger of the test's and, where that is significant, 1.4 times"));
}

TEST(Compare, RemarksThatEqualRatiosCanBeCopies) {
  const std::string remark =
      "most ratios to uniform are equal to rounding, so that the groups can be copies of one "
      "another: raw";  // copy is tied, the ratios of dual differ
  EXPECT_TRUE(has_remark(compared(sweep()), remark));
  std::vector<Record> varied = sweep();
  for (std::size_t i = 0; i < varied.size(); ++i) {
    if (varied[i].method == "raw") varied[i].statistics.rmse *= 1.0 + 0.01 * double(i);
  }
  EXPECT_FALSE(has_remark(compared(varied), remark));
}

TEST(Ratio, SaysThatTiesWidenItsInterval) {
  const auto with_ties = [](int ties) {
    std::vector<Record> records;
    for (int i = 0; i < 10; ++i) {
      records.push_back(score("room", i, "uniform", 1.0));
      records.push_back(score("room", i, "dual", i < ties ? 1.0 : 0.9 - 0.01 * i));
    }
    return compared(records);
  };
  const std::string note =
      "interval too wide (of 95 %, it contains the ratio in up to 98 % of the cases), because a "
      "fifth of the groups or more tie with uniform: dual";
  EXPECT_FALSE(has_remark(with_ties(1), note));
  EXPECT_TRUE(has_remark(with_ties(2), note));
}

}  // namespace
}  // namespace loopbench::compare_remarks_test
