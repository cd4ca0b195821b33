#include "harness/answers/tables/growth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace loopbench::harness {
namespace {

TEST(Growth, FitsAPowerBesideAFixedCost) {
  const auto exact = fitted_power({10, 100, 1000, 10'000}, {0.02, 0.2, 2, 20});
  ASSERT_TRUE(exact);
  EXPECT_NEAR(exact->exponent, 1.0, 1e-6);
  EXPECT_NEAR(exact->factor, 0.002, 1e-7);
  EXPECT_NEAR(exact->fixed, 0.0, 1e-6);
  EXPECT_NEAR(exact->half_width.value(), 0.0, 1e-2);
  // 3 + 0.01 n^1.5: without the fixed cost the exponent would be 0.6.
  const auto fixed = fitted_power({10, 40, 160, 640}, {3.31623, 5.52982, 23.2386, 164.909});
  ASSERT_TRUE(fixed);
  EXPECT_NEAR(fixed->exponent, 1.5, 1e-3);
  EXPECT_NEAR(fixed->fixed, 3.0, 1e-2);
  EXPECT_FALSE(fitted_power({10, 100, 100}, {1, 2, 3}));
  EXPECT_FALSE(fitted_power({10, 100, 1000}, {1, 0, 3}));
}

TEST(Growth, HasNoIntervalOfThreeSizes) {
  const auto law = fitted_power({10, 100, 1000}, {1, 2, 30});
  ASSERT_TRUE(law);
  EXPECT_FALSE(law->half_width);
  EXPECT_EQ(law_text(law).find("\u00b1"), std::string::npos);
}

TEST(Growth, HasIntervalsThatHoldWithAFixedCost) {
  std::mt19937_64 bits(3);
  int held = 0;
  for (int draw = 0; draw < 300; ++draw) {
    std::vector<double> sizes, values;
    for (double size = 20.0; size < 3000.0; size *= 2.0) {
      double noise = -6.0;  // nearly normal, standard deviation 1
      for (int i = 0; i < 12; ++i) noise += static_cast<double>(bits() >> 11) * 0x1p-53;
      sizes.push_back(size);
      values.push_back((2.0 + 0.02 * std::pow(size, 1.3)) * std::exp(0.05 * noise));
    }
    const auto law = fitted_power(sizes, values);
    ASSERT_TRUE(law && law->half_width);
    held += std::abs(law->exponent - 1.3) <= *law->half_width ? 1 : 0;
  }
  EXPECT_GE(held, 0.94 * 300);
}

TEST(Growth, FindsFamiliesByOptionsNotByLabels) {
  const auto room = [](std::int64_t keyframes) {
    return std::vector<Choice>{
        {"simulated", {{"path", std::string("room")}, {"keyframes", keyframes}}}};
  };
  const std::vector<OptionFamily> found = option_families(
      {{"small", room(60)},
       {"large", room(240)},
       {"road 60",
        std::vector<Choice>{
            {"simulated", {{"path", std::string("driving")}, {"keyframes", std::int64_t{60}}}}}},
       {"a text", std::vector<Choice>{{"simulated", {{"path", std::string("room, keyframes=9")}}}}},
       {"raw", std::vector<Choice>{{"raw", {}}}}});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name_with_words(), "simulated, room");
  EXPECT_EQ(found[0].options, std::vector<std::string>{"keyframes"});
  ASSERT_EQ(found[0].members.size(), 2u);
  EXPECT_EQ(found[0].members[1].name, "large");
  EXPECT_EQ(found[0].members[1].values, std::vector<double>{240.0});
}

}  // namespace
}  // namespace loopbench::harness
