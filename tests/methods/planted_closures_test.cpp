/// Planted false closures are the first that the ledger names, in simulated rounds and real files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "datasets/pose_graph_dataset.hpp"
#include "datasets/trajectory_dataset.hpp"
#include "methods/correctors/closure_ledger.hpp"
#include "tests/support/rounds.hpp"

namespace loopbench::planted_closures_test {

using namespace methods;

namespace {

/// Adds `count` false closures with three seeds; the first `count` suspects must be these.
void expect_named(const Problem& problem, std::size_t count) {
  const auto all = static_cast<double>(count + problem.closures.size());
  for (std::int64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(testing::Message() << count << " planted, seed " << seed);
    Problem planted = problem;
    ASSERT_EQ(add_false_closures(planted, {static_cast<double>(count) / all, seed}, 0).size(),
              count);
    const ClosureLedger ledger = closure_ledger(planted);
    EXPECT_TRUE(is_contradicted(ledger.verdict));
    for (std::size_t rank = 0; rank < count; ++rank) {
      const Edge& named = planted.closures[ledger.suspects[rank]];
      EXPECT_TRUE(std::ranges::none_of(
          problem.closures,
          [&](const Edge& edge) { return edge.from == named.from && edge.to == named.to; }))
          << named.from << " -> " << named.to;
    }
  }
}

/// The same in a file. Skips without the data.
template <class Load>
void expect_named_in(Load load, std::size_t count) {
  const char* root = std::getenv("LOOPBENCH_DATA");
  try {
    if (root == nullptr) throw DataMissing("LOOPBENCH_DATA is not set");
    expect_named(load(DataRoot{{root}}).problem, count);
  } catch (const DataMissing& missing) {
    GTEST_SKIP() << missing.what();
  }
}

TrajectoryOptions closures_of_reference(const std::string& estimate,
                                        const std::string& reference,
                                        int every,
                                        std::int64_t closures) {
  TrajectoryOptions out;
  out.estimate = estimate;
  out.reference = reference;
  out.keyframes = {KeyframeRule::every, static_cast<double>(every)};
  out.closures = ClosureSource::reference;
  out.closures_radius = 4.0;
  out.closures_max = closures;
  return out;
}

TEST(PlantedClosures, AreNamedInSimulatedRounds) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    expect_named(test::rounds(seed), 1);
    expect_named(test::rounds(seed), 2);
  }
}

TEST(PlantedClosures, OneOfFiveIsNamedInTheGraphOfKitti00) {
  PoseGraphOptions options;
  options.path = "kitti/00/viso2_loops_se2.g2o";
  options.keyframes_every = 5;
  options.closures_max = 4;
  expect_named_in([&](const DataRoot& root) { return load_pose_graph(options, root); }, 1);
}

TEST(PlantedClosures, OneOfTwentyIsNamedInMulran) {
  const auto options =
      closures_of_reference("mulran/DCC_01/odometry.txt", "mulran/DCC_01/reference.txt", 10, 19);
  expect_named_in([&](const DataRoot& root) { return load_trajectory(options, root); }, 1);
}

TEST(PlantedClosures, ThreeOfSixtyAreNamedInKitti00) {
  const auto options =
      closures_of_reference("kitti/00/kiss_icp_open.txt", "kitti/00/gt_poses.txt", 5, 57);
  expect_named_in([&](const DataRoot& root) { return load_trajectory(options, root); }, 3);
}

}  // namespace
}  // namespace loopbench::planted_closures_test
