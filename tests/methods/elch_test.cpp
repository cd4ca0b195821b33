#include "methods/correctors/elch.hpp"

#include <gtest/gtest.h>

#include "methods/correctors/uniform.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::elch_test {

using namespace methods;

namespace {

using namespace test;

TEST(Elch, EqualsUniformForOneLoop) {
  const Problem problem = test::drifting(
      test::hand_held_truth(50), twist({0.002, 0.001, 0.003}, {0.001, 0.002, 0.01}), {{5, 40}});
  expect_close(corrected<Elch>(problem), corrected<Uniform>(problem), 1e-9);
}

TEST(Elch, UsesTheShortcutOfAnEarlierLoop) {
  // Positions 0 .. 8 along x. The first loop joins 6 to 0 without error; the second, 0 -> 8, has an
  // error of 3 m. Its shortest path is 0 - 6 - 7 - 8, so 6, 7, 8 move by 1, 2, 3 m, and 1 .. 5 move
  // with the nearer end.
  Problem problem = along_x({0, 1, 2, 3, 4, 5, 6, 7, 8});
  problem.closures = {{0, 6, at_x(6.0)}, {0, 8, {Rotation::Identity(), {8, 3, 0}}}};
  const Trajectory out = corrected<Elch>(problem);
  const double expected[] = {0, 0, 0, 0, 1, 1, 1, 2, 3};
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (i == 3) continue;  // equally far from 0 and 6
    EXPECT_NEAR(out[i].world_from_body.translation.y(), expected[i], 1e-12) << i;
  }
}

TEST(Elch, ClosesItsLastLoop) {
  const Problem problem = test::drifting(test::hand_held_truth(60),
                                         twist({0.002, -0.001, 0.003}, {0.001, 0.002, 0.01}),
                                         {{5, 30}, {10, 45}, {2, 57}});
  EXPECT_NEAR(closing_error(problem.closures.back(), corrected<Elch>(problem)), 0.0, 1e-9);
}

}  // namespace
}  // namespace loopbench::elch_test
