/// Which rows of a curve are kept, and how columns are rounded and compressed.
#include "harness/sweep/model/packed_columns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "datasets/core/error.hpp"
#include "harness/sweep/model/kept_rows.hpp"

namespace loopbench::packed_columns_test {
namespace {

using namespace harness;

TEST(KeptRows, OfPartsThatFallApartRowByRowTakeNoQuadraticTime) {
  constexpr std::size_t kRows = 400'000;  // minutes, if each split took one row away
  std::vector<double> x(kRows), y(kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    x[i] = static_cast<double>(i);
    y[i] = (i % 2 == 0 ? 1.0 : -1.0) * (1.0 - x[i] / kRows);
  }
  std::vector<std::size_t> kept{0, kRows - 1};
  keep_deviating(kept, {{{x, y}, 0.01}});
  EXPECT_GT(kept.size(), kRows * 9 / 10);
  EXPECT_TRUE(std::ranges::is_sorted(kept));
}

TEST(KeptRows, EndsOfInterruptionsStay) {
  std::vector<double> x{0, 1, 2, 3, 4, 5, 6, 7}, y(8, 0.0);
  y[3] = y[4] = std::nan("");
  std::vector<std::size_t> kept{0, 7};
  keep_deviating(kept, {{{x, y}, 0.1}});
  EXPECT_THAT(kept, testing::ElementsAre(0, 2, 3, 4, 5, 7));
}

TEST(PackedColumns, AreRoundedToAHalfStep) {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    const std::size_t columns = 1 + random() % 4, rows = random() % 300;
    const unsigned steps = round % 2 == 0 ? kDrawnSteps : kFineSteps;
    const auto kind = random() % 4;
    std::vector<float> all;
    for (std::size_t i = 0; i < rows * columns; ++i) {
      const auto uniform = static_cast<float>(random()) / static_cast<float>(random.max());
      all.push_back(kind == 0 ? 1e4F + uniform : kind == 1 ? 5.0F : std::exp(20.0F * uniform));
      if (kind == 3 && random() % 9 == 0) all.back() = std::nanf("");
    }
    const std::string packed = packed_columns(all, columns, steps);
    const std::vector<float> found = unpacked_columns(packed, columns, steps);
    ASSERT_EQ(found.size(), all.size());
    for (std::size_t c = 0; c < columns; ++c) {
      float low = INFINITY, high = -INFINITY;
      for (std::size_t i = c; i < all.size(); i += columns) {
        if (std::isnan(all[i])) continue;
        low = std::min(low, all[i]);
        high = std::max(high, all[i]);
      }
      for (std::size_t i = c; i < all.size(); i += columns) {
        ASSERT_EQ(std::isnan(found[i]), std::isnan(all[i]));
        if (std::isnan(all[i])) continue;
        const float rounding = 1e-6F * std::abs(high);
        EXPECT_NEAR(
            found[i], all[i], 0.5001F * (high - low) / static_cast<float>(steps) + rounding);
        if (all[i] == low || all[i] == high) EXPECT_EQ(found[i], all[i]);
      }
    }
    EXPECT_EQ(packed_columns(all, columns, steps), packed);
    for (std::size_t size = 0; size < packed.size(); size += 1 + size / 8) {
      if (rows > 0)
        EXPECT_THROW(unpacked_columns(packed.substr(0, size), columns, steps), InputError);
    }
    for (int k = 0; k < 20 && !packed.empty(); ++k) {  // no crash
      std::string damaged = packed;
      damaged[random() % damaged.size()] = static_cast<char>(random());
      try {
        unpacked_columns(damaged, columns, steps);
      } catch (const InputError&) {
      }
    }
  }
}

TEST(PackedColumns, AreWhatTheHeaderDescribes) {
  // 0, 1, 2, 3 of 3 steps: words 1, 2, 3, 4, differences to the line 1, 0, 0, 0 and to the word
  // before 1, 1, 1, 1; numbers 2, 0, 0, 0. k is 0, then log2(3 / 2), 3 / 3, 3 / 4: 0.
  const std::vector<float> values{0.0F, 1.0F, 2.0F, 3.0F};
  const std::string bits("\xc0", 1);  // 110 0 0 0, and two zeros
  EXPECT_EQ(packed_columns(values, 1, 3),
            std::string("\4\0\0\0"              // rows
                        "\0\0\0\0\0\0\x40\x40"  // 0 and 3
                        "\2",
                        13) +
                bits);
}

}  // namespace
}  // namespace loopbench::packed_columns_test
