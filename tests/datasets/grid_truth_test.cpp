#include "datasets/derive/grid_truth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/dataset.hpp"
#include "tests/datasets/scratch.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::grid_truth_test {
namespace {

using testing::HasSubstr;

/// Two steps ahead, the second with a left turn, then one step to the pose (2, 1) that looks to the
/// left: from there, the start is 1 m behind and 2 m to the left.
const std::string kSteps =
    "EDGE_SE2 0 1 1.04 -0.03 0.01 1 0 0 1 0 1\n"
    "EDGE_SE2 1 2 0.97 0.02 1.55 1 0 0 1 0 1\n"
    "EDGE_SE2 2 3 1.01 0.05 -0.02 1 0 0 1 0 1\n";

Sequence load(const std::string& text, const Params& more = {}) {
  const TemporaryFolder folder;
  folder.file("grid.g2o", text);
  folder.file("truth.g2o", kSteps);
  Params given{{"path", "grid.g2o"}, {"truth_grid", true}};
  given.insert(more.begin(), more.end());
  return load_dataset("pose_graph", given, {{folder.path()}});
}

TEST(GridTruth, RoundsTheOdometry) {
  const Sequence sequence = load(kSteps + "EDGE_SE2 3 0 -0.98 2.03 -1.56 1 0 0 1 0 1\n");
  ASSERT_EQ(sequence.reference.size(), 4u);
  const Pose& last = sequence.reference[3].world_from_body;
  EXPECT_TRUE(last.translation.isApprox(Vector3(2.0, 1.0, 0.0), 1e-12));
  EXPECT_NEAR(last.rotation.z(), std::sqrt(0.5), 1e-12);
  EXPECT_DOUBLE_EQ(sequence.reference[3].stamp, sequence.problem.keyframes[3].stamp);
}

TEST(GridTruth, AnEdgeThatDisagreesIsAnError) {
  const auto refusal = [](const std::string& edge) {
    return refusal_of([&] { load(kSteps + edge); });
  };
  EXPECT_THAT(refusal("EDGE_SE2 3 0 -1.98 2.03 -1.56 1 0 0 1 0 1\n"),
              HasSubstr("grid.g2o:4: truth_grid: not simulated in a grid: this edge"));
  EXPECT_THAT(refusal(""), HasSubstr("no closures confirm it"));
  const std::string vertices =
      "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_SE2 2 2 0 0\nVERTEX_SE2 3 2 1 0\n"
      "VERTEX_SE2 4 2 2 0\n";
  EXPECT_THAT(refusal(vertices), HasSubstr("no edge from 3 to 4"));
}

TEST(GridTruth, StepsOfAnotherLengthAreAnError) {
  // Out and back in steps of 1.3 m: whole metres would agree with each other.
  EXPECT_THAT(refusal_of([] {
                load(
                    "EDGE_SE2 0 1 1.3 0 0 1 0 0 1 0 1\n"
                    "EDGE_SE2 1 2 1.3 0 3.14 1 0 0 1 0 1\n"
                    "EDGE_SE2 2 3 1.3 0 0 1 0 0 1 0 1\n"
                    "EDGE_SE2 1 3 0 0 3.14 1 0 0 1 0 1\n");
              }),
              HasSubstr("rounding changes its steps by 0.3 m on average"));
}

TEST(GridTruth, ARealGraphWithShortStepsIsAnError) {
  // All rounds to standing still, which would agree.
  EXPECT_THAT(refusal_of([] {
                load(
                    "EDGE_SE2 0 1 0.3 0.02 0.1 1 0 0 1 0 1\n"
                    "EDGE_SE2 1 2 0.3 0.01 0.2 1 0 0 1 0 1\n"
                    "EDGE_SE2 0 2 0.4 0.05 0.3 1 0 0 1 0 1\n");
              }),
              HasSubstr("grid.g2o:1: truth_grid: not simulated in a grid: a step that rounds"));
}

TEST(GridTruth, NeedsAPlanarGraphAndNoOtherTruth) {
  EXPECT_THAT(refusal_of([] {
                load(
                    "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 "
                    "0 0 1 0 1\n");
              }),
              HasSubstr("the graph is not planar"));
  EXPECT_THAT(refusal_of([] {
                load(kSteps, {{"truth", "truth.g2o"}});
              }),
              HasSubstr("truth is given too"));
}

}  // namespace
}  // namespace loopbench::grid_truth_test
