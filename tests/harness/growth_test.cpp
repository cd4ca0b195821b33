#include "harness/answers/tables/growth.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace loopbench::harness {
namespace {

TEST(Growth, FitsAPowerAndItsInterval) {
  const auto exact = fitted_power({10, 100, 1000, 10'000}, {0.02, 0.2, 2, 20});
  ASSERT_TRUE(exact);
  EXPECT_NEAR(exact->exponent, 1.0, 1e-12);
  EXPECT_NEAR(exact->factor, 0.002, 1e-12);
  EXPECT_NEAR(exact->half_width, 0.0, 1e-6);
  // Residuals -0.1, 0.2, -0.1 of the logarithms: standard error sqrt(0.06 / 2), t(1) = 12.71.
  const double e = std::exp(1.0);
  const auto rough = fitted_power({1.0, e, e * e}, {1.0, std::exp(1.3), e * e});
  ASSERT_TRUE(rough);
  EXPECT_NEAR(rough->exponent, 1.0, 1e-12);
  EXPECT_NEAR(rough->half_width, 12.71 * std::sqrt(0.03), 1e-9);
  EXPECT_FALSE(fitted_power({10, 100, 100}, {1, 2, 3}));
  EXPECT_FALSE(fitted_power({10, 100, 1000}, {1, 0, 3}));
}

TEST(Growth, ReadsFamiliesFromOptionsNotFromLabels) {
  const std::vector<OptionFamily> found =
      option_families({{"small", "simulated: path=room, keyframes=60"},
                       {"large", "simulated: path=room, keyframes=240"},
                       {"road 60", "simulated: path=driving, keyframes=60"},
                       {"sparse", "simulated: path=room, laps=3"},
                       {"raw", "raw"}});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name, "simulated, room");
  EXPECT_EQ(found[0].options, std::vector<std::string>{"keyframes"});
  ASSERT_EQ(found[0].members.size(), 2u);
  EXPECT_EQ(found[0].members[1].name, "large");
  EXPECT_EQ(found[0].members[1].values, std::vector<double>{240.0});
}

}  // namespace
}  // namespace loopbench::harness
