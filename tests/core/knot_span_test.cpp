#include "datasets/core/knot_span.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace loopbench::knot_span_test {
namespace {

const std::vector<double> kStamps = {1.0, 2.0, 4.0, 4.5, 10.0};

TEST(KnotSpan, FindsTheIntervalByHand) {
  KnotSpan span(kStamps);
  EXPECT_EQ(span.find(1.0), 0U);
  EXPECT_EQ(span.find(1.999), 0U);
  EXPECT_EQ(span.find(2.0), 1U);
  EXPECT_EQ(span.find(4.2), 2U);
  EXPECT_EQ(span.find(4.5), 3U);
  EXPECT_EQ(span.find(10.0), 3U) << "the last stamp belongs to the last interval";
}

TEST(KnotSpan, AnswerDoesNotDependOnWhatWasAskedBefore) {
  std::mt19937_64 random(3);
  KnotSpan used(kStamps);
  for (int k = 0; k < 2000; ++k) {
    const double time = 1.0 + static_cast<double>(random() % 37) * 0.25;
    EXPECT_EQ(used.find(time), KnotSpan(kStamps).find(time)) << time;
  }
}

TEST(KnotSpan, OneStampIsOneAnswer) {
  const std::vector<double> one = {3.0};
  EXPECT_EQ(KnotSpan(one).find(3.0), 0U);
  EXPECT_THROW(KnotSpan(one).find(3.1), std::out_of_range);
}

TEST(KnotSpan, RefusesTimesOutsideAndNan) {
  KnotSpan span(kStamps);
  EXPECT_THROW(span.find(0.999), std::out_of_range);
  EXPECT_THROW(span.find(10.001), std::out_of_range);
  EXPECT_THROW(span.find(std::nan("")), std::out_of_range);
  const std::vector<double> none;
  EXPECT_THROW(KnotSpan(none).find(0.0), std::out_of_range);
}

}  // namespace
}  // namespace loopbench::knot_span_test
