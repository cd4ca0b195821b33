#include "methods/find_method.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/core/error.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::find_method_test {
namespace {

using testing::HasSubstr;

TEST(FindMethod, CorrectsWithTheMethodOfTheName) {
  const Problem problem = test::circle();
  const methods::Stage stage = methods::find_method("dual").make({});
  methods::Report report;
  const Trajectory expected =
      std::get<std::unique_ptr<const methods::Corrector>>(stage)->correct(problem, report);
  const Trajectory found = methods::correct(problem, "dual");
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].world_from_body.translation, expected[i].world_from_body.translation);
  }
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
