// With 30 % false closures, robust pose graphs have at most 10 % more error than without false
// closures.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdlib>

#include "datasets/pose_graph_dataset.hpp"
#include "datasets/simulated/simulated.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "tests/support/corrected.hpp"

namespace loopbench::gnc_outliers_test {

using namespace methods;

namespace {

/// RMS position error after rigid alignment [m]. Keyframes without a reference are ignored.
double absolute_error(const Trajectory& keyframes, const Trajectory& reference) {
  const Trajectory nearest = test::at_stamps_of(keyframes, reference);
  const auto most = static_cast<Eigen::Index>(keyframes.size());
  Eigen::Matrix3Xd a(3, most), b(3, most);
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    if (std::abs(nearest[i].stamp - keyframes[i].stamp) > 1e-6) continue;
    a.col(count) = keyframes[i].world_from_body.translation;
    b.col(count++) = nearest[i].world_from_body.translation;
  }
  a.conservativeResize(3, count);
  b.conservativeResize(3, count);
  const Eigen::Matrix4d fit = Eigen::umeyama(a, b, false);
  const Eigen::Matrix3Xd fitted =
      (fit.topLeftCorner<3, 3>() * a).colwise() + Vector3(fit.topRightCorner<3, 1>());
  return std::sqrt((fitted - b).squaredNorm() / static_cast<double>(count));
}

double error_of(const Sequence& sequence, Gnc gnc) {
  return absolute_error(test::corrected<PoseGraphOptimizer>(sequence.problem, {.gnc = gnc}),
                        sequence.reference);
}

TEST(GncOutliers, ThirtyPercentAddAtMostTenPercentErrorOnSimulatedChains) {
  for (const SimulatedPath path : {SimulatedPath::driving, SimulatedPath::room}) {
    double without = 0.0, tls = 0.0, plain = 0.0;
    for (std::int64_t seed = 1; seed <= 3; ++seed) {
      SimulatedOptions options;
      options.path = path;
      options.planar = path == SimulatedPath::driving;
      options.seed = seed;
      options.stream = "shared";  // equal chain and true closures with and without false closures
      options.closures.max = 20;
      without += error_of(load_simulated(options), Gnc::off);
      options.closures.false_share = 0.3;
      const Sequence mixed = load_simulated(options);
      plain += error_of(mixed, Gnc::off);
      tls += error_of(mixed, Gnc::tls);
    }
    EXPECT_GT(plain, 2.0 * without) << to_text(path);  // false closures increase the error
    EXPECT_LT(tls, 1.1 * without) << to_text(path);
  }
}

TEST(GncOutliers, ThirtyPercentAddAtMostTenPercentErrorOnKitti00) {
  const char* root = std::getenv("LOOPBENCH_DATA");
  if (root == nullptr) GTEST_SKIP() << "LOOPBENCH_DATA is not set";
  PoseGraphOptions options;
  options.path = "robust_slam/00/kitti_00_alpha_1.00.g2o";
  options.true_list = "robust_slam/00/kitti_00_alpha_1.00_GT_LC.txt";
  options.truth = "kitti/00/gt_poses.txt";
  options.truth_axes = TruthAxes::kitti_camera;
  options.reference_body.x = 2.24;
  options.reference_body.y = -0.1;
  options.keyframes_every = 5;
  try {
    const double without = error_of(load_pose_graph(options, {{root}}), Gnc::off);
    options.false_closures.share = 0.3;
    const Sequence mixed = load_pose_graph(options, {{root}});
    EXPECT_GT(error_of(mixed, Gnc::off), 10.0 * without);
    EXPECT_LT(error_of(mixed, Gnc::tls), 1.1 * without);
  } catch (const DataMissing& missing) {
    GTEST_SKIP() << missing.what();
  }
}

}  // namespace
}  // namespace loopbench::gnc_outliers_test
