// Common tests of the Lie groups of pose graphs.
#include <gtest/gtest.h>

#include <random>

#include "methods/solvers/groups/level.hpp"
#include "methods/solvers/groups/se2.hpp"
#include "methods/solvers/groups/se3.hpp"
#include "methods/solvers/groups/sim3.hpp"
#include "methods/solvers/residuals.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::pose_graph_groups_test {

using namespace methods;

namespace {

template <class G>
class PoseGroup : public ::testing::Test {
 protected:
  using Tangent = typename G::Tangent;
  using Square = typename G::Square;
  using Element = typename G::Element;

  /// Uniform in -size..size; the sizes below cover small, ordinary and nearly half-turn twists.
  Tangent random(double size) {
    std::uniform_real_distribution<double> unit(-size, size);
    Tangent out;
    for (int i = 0; i < G::kDof; ++i) out[i] = unit(random_);
    return out;
  }
  std::vector<Tangent> twists() {
    std::vector<Tangent> out{Tangent::Zero()};
    for (const double size : {1e-9, 1e-4, 0.1, 1.0, 1.7}) {
      for (int i = 0; i < 5; ++i) out.push_back(random(size));
    }
    return out;
  }
  static Tangent difference(const Element& a, const Element& b) {
    return G::log(G::compose(G::inverse(a), b));
  }

  std::mt19937_64 random_{11};
};
using Groups = ::testing::Types<Se2, Se3, Sim3, Level>;
TYPED_TEST_SUITE(PoseGroup, Groups);

TYPED_TEST(PoseGroup, LogUndoesExp) {
  for (const auto& xi : this->twists()) {
    EXPECT_NEAR((TypeParam::log(TypeParam::exp(xi)) - xi).norm(), 0.0, 1e-12) << xi.transpose();
  }
}

TYPED_TEST(PoseGroup, InverseAndStorageAreExact) {
  using G = TypeParam;
  for (const auto& xi : this->twists()) {
    const auto a = G::exp(xi);
    EXPECT_NEAR(G::log(G::compose(a, G::inverse(a))).norm(), 0.0, 1e-14);
    double stored[G::kSize];
    G::write(a, stored);
    EXPECT_NEAR(this->difference(a, G::read(stored)).norm(), 0.0, 1e-14);
    EXPECT_NEAR(this->difference(a, G::from(G::to_scaled_pose(a))).norm(), 0.0, 1e-14);
  }
}

TYPED_TEST(PoseGroup, AdjointTransformsTwists) {
  using G = TypeParam;
  for (const auto& xi : this->twists()) {
    const auto a = G::exp(this->random(1.0));
    const auto left = G::compose(a, G::exp(xi));
    const auto right = G::compose(G::exp(G::adjoint(a) * xi), a);
    EXPECT_NEAR(this->difference(left, right).norm(), 0.0, 1e-12);
  }
}

TYPED_TEST(PoseGroup, ResidualJacobiansAgreeWithDifferences) {
  using G = TypeParam;
  for (const auto& xi : this->twists()) {
    const auto from = G::exp(this->random(1.0));
    const auto measured = G::exp(this->random(1.0));
    const auto to = G::compose(G::compose(from, measured), G::exp(xi));
    const auto inverse_measured = G::inverse(measured);
    const auto at = edge_residual<G>(inverse_measured, from, to);
    EXPECT_NEAR((at.error - xi).norm(), 0.0, 1e-12);
    const auto error = [&](const auto& a, const auto& b) {
      return group_edge_error<G>(inverse_measured, G::compose(G::inverse(a), b));
    };
    constexpr double h = 1e-5;
    for (int d = 0; d < G::kDof; ++d) {
      typename G::Tangent step = G::Tangent::Zero();
      step[d] = h;
      const auto up = G::exp(step);
      const auto down = G::exp(-step);
      const typename G::Tangent by_from =
          (error(G::compose(from, up), to) - error(G::compose(from, down), to)) / (2.0 * h);
      const typename G::Tangent by_to =
          (error(from, G::compose(to, up)) - error(from, G::compose(to, down))) / (2.0 * h);
      EXPECT_NEAR((at.by_from.col(d) - by_from).norm(), 0.0, 1e-7) << xi.transpose() << " by " << d;
      EXPECT_NEAR((at.by_to.col(d) - by_to).norm(), 0.0, 1e-7) << xi.transpose() << " by " << d;
    }
  }
}

TEST(PoseGroups, OthersAgreeWithSe3OnTheirIntersection) {
  const Eigen::Vector3d flat(0.3, -0.2, 0.7);
  const Pose lifted = exp_se3(twist({0.3, -0.2, 0.0}, {0.0, 0.0, 0.7}));
  EXPECT_POSE_NEAR(Se2::to_scaled_pose(Se2::exp(flat)).pose, lifted, 1e-15, 1e-15);
  const Level::Tangent level(0.3, -0.2, 0.9, 0.7);
  const Pose risen = exp_se3(twist({0.3, -0.2, 0.9}, {0.0, 0.0, 0.7}));
  EXPECT_POSE_NEAR(Level::to_scaled_pose(Level::exp(level)).pose, risen, 1e-15, 1e-15);
  Sim3::Tangent unscaled = Sim3::Tangent::Zero();
  unscaled.head<6>() = twist({0.3, -0.2, 0.9}, {0.4, -0.5, 0.7});
  EXPECT_POSE_NEAR(Sim3::exp(unscaled).pose, exp_se3(unscaled.head<6>()), 1e-14, 1e-14);
  const Sim3::Square J = Sim3::left_jacobian(unscaled);
  EXPECT_NEAR((J.topLeftCorner<6, 6>() - left_jacobian_se3(unscaled.head<6>())).norm(), 0.0, 1e-13);
}

TEST(PoseGroups, AScaledStepAlongAStraightLineIsAGeometricSeries) {
  // One unit ahead while the scale doubles: the second step is twice as long. By hand: e^lambda = 2
  // and translation = rho (e^lambda - 1) / lambda.
  const ScaledPose step{{Rotation::Identity(), {1.0, 0.0, 0.0}}, 2.0};
  const ScaledPose two = step * step;
  EXPECT_DOUBLE_EQ(two.pose.translation.x(), 3.0);
  EXPECT_DOUBLE_EQ(two.scale, 4.0);
  const Sim3::Tangent xi = Sim3::log(step);
  EXPECT_NEAR(xi[0], std::log(2.0), 1e-15);
  EXPECT_NEAR(xi[6], std::log(2.0), 1e-15);
}

}  // namespace
}  // namespace loopbench::pose_graph_groups_test
