#include "datasets/derive/keyframes.hpp"

#include <gtest/gtest.h>

#include "datasets/core/params.hpp"
#include "tests/datasets/random_poses.hpp"

namespace loopbench::keyframes_test {
namespace {

using Indices = std::vector<std::size_t>;

Trajectory line(std::size_t size, double period = 1.0) {
  std::vector<double> xs;
  for (std::size_t i = 0; i < size; ++i) xs.push_back(static_cast<double>(i));
  return on_a_line(xs, period);
}

TEST(Keyframes, AllKeepsAll) {
  EXPECT_EQ(choose_keyframes(line(3), {KeyframeRule::all, 7.0}), (Indices{0, 1, 2}));
}

TEST(Keyframes, EveryThirdKeepsFirstAndLast) {
  EXPECT_EQ(choose_keyframes(line(9), {KeyframeRule::every, 3.0}), (Indices{0, 3, 6, 8}));
  EXPECT_EQ(choose_keyframes(line(10), {KeyframeRule::every, 3.0}), (Indices{0, 3, 6, 9}));
  EXPECT_EQ(choose_keyframes(line(4), {KeyframeRule::every, 100.0}), (Indices{0, 3}));
}

TEST(Keyframes, SecondsAreAtLeastThatFarApart) {
  const Trajectory poses = line(8, 0.1);
  EXPECT_EQ(choose_keyframes(poses, {KeyframeRule::seconds, 0.25}), (Indices{0, 3, 6, 7}));
  // 0.3 s is three steps although 3 * 0.1 - 0.0 and 6 * 0.1 - 3 * 0.1 differ in their last bit.
  EXPECT_EQ(choose_keyframes(poses, {KeyframeRule::seconds, 0.3}), (Indices{0, 3, 6, 7}));
}

TEST(Keyframes, MetresAreStraightFromTheKeyframeBefore) {
  const Trajectory poses = on_a_line({0.0, 0.5, 0.9, 1.0, 1.5, 0.2, 0.0, 0.0});
  EXPECT_EQ(choose_keyframes(poses, {KeyframeRule::metres, 1.0}), (Indices{0, 3, 6, 7}));
}

TEST(Keyframes, CountIsEvenAndExact) {
  EXPECT_EQ(choose_keyframes(line(9), {KeyframeRule::count, 5.0}), (Indices{0, 2, 4, 6, 8}));
  EXPECT_EQ(choose_keyframes(line(6), {KeyframeRule::count, 3.0}), (Indices{0, 3, 5}));
  EXPECT_EQ(choose_keyframes(line(1352), {KeyframeRule::count, 180.0}).size(), 180u);
  EXPECT_EQ(choose_keyframes(line(7), {KeyframeRule::count, 7.0}).size(), 7u);
}

TEST(Keyframes, OfNothingAreNone) {
  EXPECT_TRUE(choose_keyframes({}, {KeyframeRule::every, 2.0}).empty());
  EXPECT_EQ(choose_keyframes(line(1), {KeyframeRule::seconds, 2.0}), (Indices{0}));
}

TEST(Keyframes, RefuseValuesThatDoNotFitTheRule) {
  EXPECT_THROW(choose_keyframes(line(9), {KeyframeRule::every, 1.5}), OptionError);
  EXPECT_THROW(choose_keyframes(line(9), {KeyframeRule::every, 0.0}), OptionError);
  EXPECT_THROW(choose_keyframes(line(9), {KeyframeRule::count, 1.0}), OptionError);
  EXPECT_THROW(choose_keyframes(line(9), {KeyframeRule::count, 10.0}), OptionError);
  EXPECT_THROW(choose_keyframes(line(9), {KeyframeRule::seconds, 0.0}), OptionError);
  EXPECT_THROW(choose_keyframes(line(9), {KeyframeRule::metres, -1.0}), OptionError);
}

TEST(Keyframes, AndFramesAreThePosesToldApart) {
  const auto [keyframes, frames] = split(line(5), {0, 2, 4});
  EXPECT_EQ(stamps(keyframes), (std::vector{0.0, 2.0, 4.0}));
  EXPECT_EQ(stamps(frames), (std::vector{1.0, 3.0}));
}

TEST(Keyframes, HaveOnlyFramesBetweenThem) {
  const Trajectory keyframes = split(line(8), {2, 4, 6}).keyframes;
  Trajectory frames = line(8);
  frames[4].stamp += 1e-6;  // different rounding in the other file
  EXPECT_EQ(stamps(non_keyframes_between(keyframes, frames)), (std::vector{3.0, 5.0}));
  EXPECT_TRUE(non_keyframes_between({}, frames).empty());
}

}  // namespace
}  // namespace loopbench::keyframes_test
