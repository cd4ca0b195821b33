#include "methods/find_method.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/core/error.hpp"
#include "methods/correctors/dual.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::find_method_test {
namespace {

using testing::HasSubstr;

TEST(FindMethod, CorrectsWithTheMethodOfTheName) {
  const Problem problem = test::circle();
  const Trajectory expected = test::corrected<methods::Dual>(problem);
  const Trajectory found = methods::correct(problem, "dual");
  ASSERT_EQ(found.size(), expected.size());
  EXPECT_EQ(test::largest_distance(found, expected), 0.0);
}

TEST(FindMethod, RejectsWhatCannotCorrect) {
  Problem problem = test::circle();
  const auto why = [&](const std::string& name) {
    return refusal_of([&] { methods::correct(problem, name); });
  };
  EXPECT_THAT(why("duel"), HasSubstr("no method is named 'duel', expected one of raw, uniform"));
  EXPECT_EQ(why("polyline"), "polyline: is a smoother, expected a corrector");
  problem.odometry.clear();
  EXPECT_THAT(why("dual"), HasSubstr("dual: is not applicable: "));
}

}  // namespace
}  // namespace loopbench::find_method_test
