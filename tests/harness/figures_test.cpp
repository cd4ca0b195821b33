/// Figures: their legend.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/plot/legend.hpp"

namespace loopbench::figures_test {
namespace {

using namespace harness;
using testing::HasSubstr;
using testing::Not;

TEST(Figures, LegendIsLimitedAndCountsTheRest) {
  PlotPanel panel;
  for (int i = 0; i < 20; ++i) {
    panel.series.push_back({"method " + std::to_string(i), "#000000", false, {{0, 0, 0}}});
  }
  const Legend legend({panel, panel}, "a note", 3.5, 8.0);
  const std::string script = legend.script(5.0);
  EXPECT_THAT(script, HasSubstr("'method 10'"));
  EXPECT_THAT(script, Not(HasSubstr("'method 11'")));
  EXPECT_THAT(script, HasSubstr("'and 9 more'"));
  EXPECT_THAT(script, HasSubstr("'a note'"));
  EXPECT_GT(legend.height(), 4.0 * 8.0 / 72.0);  // four rows
  EXPECT_LT(legend.height(), 8.0 * 1.5 * 8.0 / 72.0);
}

}  // namespace
}  // namespace loopbench::figures_test
