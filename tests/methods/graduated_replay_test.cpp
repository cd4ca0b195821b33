/// Replays of pose_graph_incremental_graduated with many false closures.
#include <gtest/gtest.h>

#include <cstdlib>

#include "datasets/pose_graph_dataset.hpp"
#include "methods/correctors/pose_graph_incremental.hpp"
#include "methods/online/online.hpp"
#include "methods/pipeline.hpp"
#include "tests/support/corrected.hpp"

namespace loopbench::graduated_replay_test {

using namespace methods;

namespace {

// A false closure is often accepted when it arrives alone; later ones must be able to reject it.
TEST(GraduatedReplay, EndsWhereTheMethodEndsAtOnceOnKitti00) {
  const char* root = std::getenv("LOOPBENCH_DATA");
  if (root == nullptr) GTEST_SKIP() << "LOOPBENCH_DATA is not set";
  const IncrementalSettings graduated{.robust = IncrementalRobustness::graduated};
  PoseGraphOptions options;
  options.path = "kitti/00/viso2_loops_se2.g2o";
  options.keyframes_every = 5;
  options.closures_max = 30;
  options.false_closures.share = 0.3;
  for (const std::int64_t seed : {1, 4, 5}) {
    options.false_closures.seed = seed;
    Problem problem;
    try {
      problem = load_pose_graph(options, {{root}}).problem;
    } catch (const DataMissing& missing) {
      GTEST_SKIP() << missing.what();
    }
    const auto replay =
        Online({}).replayed(compose(std::make_unique<IncrementalPoseGraph>(graduated), nullptr));
    Report report;
    const auto curve = replay->estimate(problem, report);
    const Trajectory expected = test::corrected<IncrementalPoseGraph>(problem, graduated);
    double largest = 0.0;
    for (const StampedPose& pose : expected) {
      const Vector3 off = curve->at(pose.stamp).translation - pose.world_from_body.translation;
      largest = std::max(largest, off.norm());
    }
    EXPECT_LT(largest, 0.01) << seed;
  }
}

}  // namespace
}  // namespace loopbench::graduated_replay_test
