#include "metrics/checks/association_error.hpp"

#include <gtest/gtest.h>

#include "metrics/errors/ate.hpp"
#include "metrics/protocols/protocols.hpp"
#include "support.hpp"

namespace loopbench::test::association_error_test {
namespace {

/// A circle of radius 50 m at `speed` with `rate` poses per second, the first at `shift`.
Trajectory round_trip(double rate, double shift, double speed) {
  constexpr double kRadius = 50.0;
  Trajectory out;
  for (int i = 0; i < static_cast<int>(20.0 * rate); ++i) {
    const double stamp = shift + i / rate;
    const double angle = speed * stamp / kRadius;
    out.push_back(
        {stamp,
         {exp_so3({0.0, 0.0, angle}), kRadius * Vector3(std::cos(angle), std::sin(angle), 0.0)}});
  }
  return out;
}

Evaluation evaluated(const Trajectory& reference, const Trajectory& estimate, Association how) {
  return evaluate(reference,
                  estimate,
                  {.association = how, .max_diff = 0.02, .max_gap = 0.1, .align = Align::none});
}

TEST(AssociationError, IsWhatAPerfectEstimatePays) {
  // 10 Hz against 25 Hz: differences of 0, 4, 8, ... to 20 ms at 15 m/s.
  const Trajectory reference = round_trip(25.0, 0.0, 15.0);
  const Trajectory perfect = round_trip(10.0, 0.013, 15.0);
  for (const Association how : {Association::nearest, Association::tum, Association::evo}) {
    const Evaluation got = evaluated(reference, perfect, how);
    const auto found = association_error(reference, got);
    ASSERT_TRUE(found);
    const double error = find(ate(got, {}), "translation", "3d").rmse;
    EXPECT_GT(error, 0.1);
    EXPECT_NEAR(found->metres, error, 1e-3 * error);
    EXPECT_LE(found->largest_difference, 0.02);
    EXPECT_GT(found->largest_difference, 0.01);
  }
  const Evaluation between = evaluated(reference, perfect, Association::interpolate);
  EXPECT_FALSE(association_error(reference, between));
  EXPECT_LT(find(ate(between, {}), "translation", "3d").rmse, 1e-3);
}

TEST(AssociationError, IsZeroForEqualStampsAndUsesTheOffset) {
  const Trajectory reference = round_trip(10.0, 0.0, 15.0);
  EXPECT_EQ(
      association_error(reference, evaluated(reference, reference, Association::nearest))->metres,
      0.0);
  Trajectory late = reference;
  for (StampedPose& pose : late) pose.stamp -= 100.0;
  Protocol rules{.offset = 100.0, .align = Align::none};
  EXPECT_NEAR(association_error(reference, evaluate(reference, late, rules))->metres, 0.0, 1e-9);
}

TEST(InterpolateReference, TakesAReferenceOfTenHertz) {
  // Steps of 0.1 s round to slightly more than 0.1 in every second pair of such stamps.
  Trajectory reference;
  Trajectory estimate;
  for (int i = 0; i <= 1000; ++i) reference.push_back({1.7e9 + 0.1 * i, {}});
  for (int i = 0; i < 1000; ++i) estimate.push_back({1.7e9 + 0.1 * i + 0.05, {}});
  EXPECT_EQ(interpolate_reference(reference, estimate, 0.1, 0.0).reference.size(), 1000u);
  EXPECT_EQ(interpolate_reference(reference, estimate, 0.0999, 0.0).reference.size(), 0u);
}

}  // namespace
}  // namespace loopbench::test::association_error_test
