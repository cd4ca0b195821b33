#include <gtest/gtest.h>

#include "metrics/errors/ate.hpp"
#include "metrics/evaluation/evaluation.hpp"
#include "metrics/protocols/protocols.hpp"
#include "support.hpp"

namespace loopbench::test::planar_alignment_test {
namespace {

/// A straight run along x with errors to the side that a reflection would reduce.
Trajectory corridor(double side) {
  Trajectory out;
  for (int i = 0; i <= 200; ++i) {
    const double x = 0.1 * i;
    out.push_back({0.1 * i, {exp_so3({0.0, 0.0, 1e-3 * i}), {x, side * std::sin(x), 0.0}}});
  }
  return out;
}

double degrees(const Evaluation& evaluation) { return ate(evaluation, {}).at(1).statistics.max; }

TEST(PlanarAlignment, DoesNotTurnAStraightRunOver) {
  const Trajectory reference = corridor(0.02), estimate = corridor(-0.02);
  const Evaluation spatial = evaluate(reference, estimate, {.planar = Planar::no});
  EXPECT_FALSE(spatial.planar);
  EXPECT_GT(degrees(spatial), 170.0);
  const Evaluation planar = evaluate(reference, estimate);
  EXPECT_TRUE(planar.planar);
  EXPECT_LT(degrees(planar), 1.0);
}

TEST(PlanarAlignment, EqualsLeastSquaresInSpaceOnACurve) {
  std::mt19937_64 random(1);
  Trajectory reference = corridor(0.0);
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double u = 0.03 * static_cast<double>(i);
    reference[i].world_from_body = {exp_so3({0.0, 0.0, u}), {std::sin(u), -std::cos(u), 0.0}};
  }
  Trajectory noisy = reference;
  std::normal_distribution<double> noise(0.0, 0.05);
  for (auto& [stamp, pose] : noisy) pose.translation += Vector3(noise(random), noise(random), 0.0);
  const Pose elsewhere{exp_so3({0.4, -1.1, 2.0}), {30.0, -20.0, 10.0}};
  const Trajectory estimate = test::moved_by(elsewhere, 1.3, noisy);
  for (const Align type : {Align::se3, Align::sim3}) {
    const Alignment planar = evaluate(reference, estimate, {.align = type}).alignment;
    const Alignment spatial =
        evaluate(reference, estimate, {.align = type, .planar = Planar::no}).alignment;
    EXPECT_NEAR(planar.scale, spatial.scale, 1e-12);
    EXPECT_TRUE(
        is_close(planar.reference_from_estimate, spatial.reference_from_estimate, 1e-10, 1e-12));
  }
}

TEST(PlanarAlignment, IsSpatialIfOneTrajectoryIs) {
  Trajectory rough = corridor(0.02);
  rough[3].world_from_body.translation.z() = 0.01;
  EXPECT_FALSE(evaluate(corridor(0.02), rough).planar);
  EXPECT_FALSE(evaluate(rough, corridor(0.02)).planar);
  const Evaluation forced = evaluate(rough, corridor(-0.02), {.planar = Planar::yes});
  EXPECT_TRUE(forced.planar);
  EXPECT_LT(degrees(forced), 1.0);
  EXPECT_EQ(forced.reference[3].world_from_body.translation.z(), 0.0);
}

TEST(PlanarAlignment, IsSpatialIfZIsUpInOneAndDownInTheOther) {
  Trajectory up;
  for (int i = 0; i <= 200; ++i) {
    const double u = 0.03 * i;
    up.push_back({0.1 * i, {exp_so3({0.0, 0.0, u}), {std::sin(u), -std::cos(u), 0.0}}});
  }
  const Pose over{Rotation(0.0, 1.0, 0.0, 0.0), Vector3::Zero()};
  Trajectory down = up;
  for (auto& [stamp, pose] : down) pose = over * pose * over;
  for (const bool has_rotations : {true, false}) {
    if (!has_rotations) {
      for (auto& [stamp, pose] : down) pose.rotation = no_rotation();
    }
    const Evaluation evaluation = evaluate(down, up);
    EXPECT_FALSE(evaluation.planar);
    EXPECT_NEAR(ate(evaluation, {}).at(0).statistics.max, 0.0, 1e-9);
    EXPECT_TRUE(evaluate(down, up, {.planar = Planar::yes}).planar);
  }
}

TEST(PlanarAlignment, KeepsTheSideOfPositionsWithoutRotation) {
  Trajectory reference = corridor(0.02);
  for (auto& [stamp, pose] : reference) pose.rotation = no_rotation();
  const Evaluation evaluation = evaluate(reference, corridor(-0.02));
  EXPECT_TRUE(evaluation.planar);
  EXPECT_GT(evaluation.alignment.reference_from_estimate.rotation.w(), 0.99);
}

TEST(PlanarAlignment, IsNoneOfTheOtherTools) {
  for (const ProtocolEntry& entry : protocols()) {
    EXPECT_EQ(entry.protocol.planar == Planar::automatic, entry.name == "loopbench") << entry.name;
  }
}

}  // namespace
}  // namespace loopbench::test::planar_alignment_test
