// Edges whose information is not positive definite.
#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>

#include "datasets/formats/g2o_information.hpp"
#include "datasets/pose_graph_dataset.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::indefinite_information_test {
namespace {

using testing::HasSubstr;

/// Like cubicle.g2o: of the two edges, the second stores 3 (x, yaw) at z, roll and -1 (y, yaw) at
/// z, pitch. It is not positive definite, because 2 * 2 < 3 * 3.
constexpr const char* kText =
    "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 4 0 0 0 0 0 4 0 0 0 0 4 0 0 0 8 0 0 8 0 8\n"
    "EDGE_SE3:QUAT 1 2 1 0 0 0 0 0 1 4 0 0 0 0 0 4 0 0 0 0 2 3 -1 0 2 0 0 2 0 9\n";

PoseGraph graph(const TemporaryFolder& folder, IndefiniteInformation how) {
  return read_g2o(folder.file("two.g2o", kText), {RotationInformation::angles, how});
}

TEST(IndefiniteInformation, IsRejectedByDefault) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal([&] { read_g2o(folder.file("two.g2o", kText)); }),
              HasSubstr("two.g2o:2: information is not positive definite"));
}

TEST(IndefiniteInformation, RepairMovesPlanarTerms) {
  const TemporaryFolder folder;
  const PoseGraph out = graph(folder, IndefiniteInformation::repair);
  EXPECT_EQ(out.altered, 1u);
  Matrix6 expected = Matrix6::Zero();
  expected.diagonal() << 4, 4, 2, 2, 2, 9;
  expected(0, 5) = expected(5, 0) = 3;
  expected(1, 5) = expected(5, 1) = -1;
  EXPECT_EQ(out.edges[1].information, expected);
  EXPECT_EQ(out.edges[0].information(5, 5), 8.0);  // positive definite: as written
}

TEST(IndefiniteInformation, ProjectionRaisesEigenvalues) {
  const TemporaryFolder folder;
  const PoseGraph out = graph(folder, IndefiniteInformation::project);
  // z, roll, pitch: 2 and 2 -+ sqrt(10); the others 4, 4, 9. The negative one becomes 9e-6.
  Eigen::SelfAdjointEigenSolver<Matrix6> eigen(out.edges[1].information);
  Twist expected;
  expected << 9e-6, 2, 4, 4, 2 + std::sqrt(10.0), 9;
  EXPECT_NEAR((eigen.eigenvalues() - expected).norm(), 0.0, 1e-12);
}

TEST(IndefiniteInformation, IsRejectedIfTheRepairDoesNotHelp) {
  const TemporaryFolder folder;
  const auto file = folder.file("planar.g2o", "EDGE_SE2 0 1 1 0 0 1 2 0 1 0 1\n");
  EXPECT_THAT(refusal([&] {
                read_g2o(file, {RotationInformation::half_angles, IndefiniteInformation::repair});
              }),
              HasSubstr("planar.g2o:1: information is not positive definite and "));
  const PoseGraph out =
      read_g2o(file, {RotationInformation::half_angles, IndefiniteInformation::project});
  EXPECT_NEAR(planar_block(out.edges[0].information)(0, 0), 1.5, 1e-5);  // eigenvalues 3 and 3e-6
}

TEST(IndefiniteInformation, IsStatedWithTheClosures) {
  const TemporaryFolder folder;
  PoseGraphOptions options;
  options.path = folder.file("two.g2o", kText).string();
  options.rules.indefinite = IndefiniteInformation::repair;
  EXPECT_THAT(load_pose_graph(options, {}).provenance.closures,
              HasSubstr("; indefinite information of 1 edges repaired"));
}

}  // namespace
}  // namespace loopbench::indefinite_information_test
