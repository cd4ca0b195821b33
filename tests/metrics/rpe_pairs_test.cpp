/// Number of pairs of a relative error, and definition of its axes.
#include <gtest/gtest.h>

#include "metrics/errors/rpe.hpp"
#include "metrics/metric.hpp"
#include "metrics/protocols/protocols.hpp"
#include "support.hpp"

namespace loopbench::test::rpe_pairs_test {
namespace {

const RpeOptions kSecond{.delta = 1.0, .unit = DeltaUnit::s};

/// 70 keyframes 0.7 s apart, except two that are 1 s apart.
Trajectory sparse(std::mt19937_64& random) {
  Trajectory out = random_walk(random, 70);
  double stamp = 0.0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].stamp = stamp;
    stamp += i == 33 ? 1.0 : 0.7;
  }
  return out;
}

TEST(RpePairs, OnePairOfManyPosesIsNoNumber) {
  std::mt19937_64 random(11);
  const Trajectory reference = sparse(random);
  const Trajectory estimate = noisy(random, reference, 0.1, 0.1);
  const Evaluation evaluated = evaluate(reference, estimate, Protocol{});
  EXPECT_EQ(evaluated.coverage.pairs, 70u);
  EXPECT_EQ(why<Undefined>([&] { rpe(evaluated, kSecond); }),
            "found 1 pair 1.0 s apart among 70 poses, fewer than min_pairs = 10");

  RpeOptions any = kSecond;
  any.min_pairs = 1.0;
  EXPECT_EQ(find(rpe(evaluated, any), "translation", "3d").count, 1u);
  RpeOptions wide = kSecond;
  wide.tolerance = 0.5;
  EXPECT_EQ(find(rpe(evaluated, wide), "translation", "3d").count, 69u);
}

TEST(RpePairs, OtherToolsTakeAnyNumber) {
  for (const ProtocolEntry& entry : protocols()) {
    EXPECT_EQ(entry.protocol.min_pairs, entry.name == "loopbench" ? 10 : 1) << entry.name;
  }
}

TEST(RpePairs, ConsecutiveSecondsAreThoseAskedFor) {
  std::mt19937_64 random(12);
  Trajectory reference = random_walk(random, 301);
  for (std::size_t i = 0; i < reference.size(); ++i) {
    reference[i].stamp = static_cast<double>(i) / 15.0;  // 15 Hz
  }
  const Trajectory estimate = noisy(random, reference, 0.1, 0.1);
  const Evaluation evaluated = evaluate(reference, estimate, named_protocol("evo").rules);
  const auto of = [&](double delta) {
    return rpe(evaluated, {.delta = delta, .unit = DeltaUnit::s});
  };
  EXPECT_EQ(why<Undefined>([&] { of(0.1); }), "none of 301 poses is 0.1 s before another");
  EXPECT_EQ(find(of(0.2), "translation", "3d").count, 100u);
}

TEST(RpePairs, RandomOnesHaveNoDelta) {
  std::mt19937_64 random(14);
  const Trajectory walk = random_walk(random, 101);  // 0.1 s apart
  const Params drawn{{"pairs", std::string("tum_random")}};
  const Evaluation evaluated = evaluate(walk, walk, named_protocol("tum", drawn).rules);
  EXPECT_EQ(why<Undefined>([&] { rpe(evaluated, kSecond); }),
            "pairs tum_random ignore delta = 1.0 s; use rpe without delta and unit");
  EXPECT_EQ(rpe(evaluated, {.unit = DeltaUnit::s, .pairs = RpePairs::tum}).front().statistics.count,
            90u);
}

TEST(RpeAxes, AreComponentsOfTheErrorTransform) {
  std::mt19937_64 random(13);
  const Trajectory reference = random_walk(random, 200);
  const Trajectory estimate = noisy(random, reference, 0.2, 0.5);
  for (const char* name : {"loopbench", "evo", "tum", "kitti"}) {
    Params same_length{{"align", std::string("se3")}};
    const Evaluation evaluated =
        evaluate(reference, estimate, named_protocol(name, same_length).rules);
    const auto scores = rpe(evaluated, {.delta = 5.0});
    const Statistics complete = find(scores, "translation", "3d");
    double squares = 0.0;
    for (const char* axis : {"x", "y", "z"}) {
      const Statistics part = find(scores, "translation", axis);
      EXPECT_LE(part.rmse, complete.rmse) << name;
      squares += part.rmse * part.rmse;
    }
    EXPECT_NEAR(squares, complete.rmse * complete.rmse, 1e-12) << name;
  }
}

}  // namespace
}  // namespace loopbench::test::rpe_pairs_test
