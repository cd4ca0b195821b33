#include "datasets/pose_graph_dataset.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "datasets/derive/graph_parts.hpp"
#include "datasets/derive/odometry.hpp"
#include "tests/datasets/random_poses.hpp"
#include "tests/datasets/scratch.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::pose_graph_dataset_test {
namespace {

using testing::HasSubstr;

const Pose kAside{Rotation::Identity(), {0.0, 0.5, 0.0}};

/// Ids from 100 on a random walk with loops 3-17 and 5-12, and a second edge 4-5.
PoseGraph small_graph(bool with_vertices) {
  PoseGraph graph;
  const Trajectory walk = random_walk(20, 9, 1.0, 0.3);
  for (std::size_t i = 0; i < walk.size(); ++i) {
    graph.ids.push_back(static_cast<std::int64_t>(i) + 100);
    if (with_vertices) graph.vertices.push_back(walk[i].world_from_body);
  }
  graph.edges = odometry_edges(walk, {});
  for (const auto& [from, to] : {std::pair{3, 17}, {5, 12}, {4, 5}}) {
    graph.edges.push_back({static_cast<std::size_t>(from),
                           static_cast<std::size_t>(to),
                           kAside,
                           isotropic_information(1.0, 1.0)});
  }
  for (std::size_t i = 0; i < graph.edges.size(); ++i) graph.lines.push_back(i + 1);
  return graph;
}

PoseGraphOptions every(std::int64_t step) {
  PoseGraphOptions options;
  options.keyframes_every = step;
  return options;
}

TEST(PoseGraphDataset, OdometryIsTheChainAndTheRestCloses) {
  const Problem problem = derive_problem(small_graph(true), every(1), "g");
  check(problem, "g");
  EXPECT_EQ(problem.keyframes.size(), 20u);
  EXPECT_EQ(problem.odometry.size(), 19u);
  EXPECT_TRUE(problem.frames.empty());
  ASSERT_EQ(problem.closures.size(), 3u);  // sorted by (to, from)
  EXPECT_EQ(problem.closures[0].from, 4u);
  EXPECT_EQ(problem.closures[1].to, 12u);
  EXPECT_EQ(problem.closures[2].to, 17u);
  EXPECT_DOUBLE_EQ(problem.keyframes[3].stamp, 10.3);
}

TEST(PoseGraphDataset, CountsCorrelationsWithTheScaleThatAreNotUsed) {
  const TemporaryFolder scratch;
  const auto count_of = [&](const std::string& information) {
    const std::string pose = " 1 0 0 0 0 0 1 1 ", end = information + "\n";
    const auto file =
        scratch.file("a.g2o",
                     "VERTEX_RST3:QUAT 0 0 0 0 0 0 0 1 1\nVERTEX_RST3:QUAT 1 1 0 0 0 0 0 1 1\n"
                     "EDGE_RST3:QUAT 0 1" +
                         pose + end);
    return read_g2o(file).scale_correlations;
  };
  EXPECT_EQ(count_of("1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1"), 0u);
  EXPECT_EQ(count_of("1 0 0 0 0 0 0 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1"), 0u);
  EXPECT_EQ(count_of("1 0 0 0 0 0 0.5 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1"), 1u);
}

TEST(PoseGraphDataset, LoopEndsStayKeyframes) {
  const Problem problem = derive_problem(small_graph(true), every(10), "g");
  check(problem, "g");
  std::vector<double> expected;  // 0 10 19 and 3 17 5 12 4
  for (const double id : {100, 103, 104, 105, 110, 112, 117, 119}) expected.push_back(id * 0.1);
  EXPECT_EQ(stamps(problem.keyframes), expected);
  EXPECT_EQ(problem.ids, (std::vector<std::int64_t>{100, 103, 104, 105, 110, 112, 117, 119}));
  EXPECT_EQ(problem.frames.size(), 12u);
  ASSERT_EQ(problem.closures.size(), 3u);
  EXPECT_EQ(problem.closures[1].from, 3u);  // pose 5
  EXPECT_EQ(problem.closures[1].to, 5u);    // pose 12
  EXPECT_EQ(problem.closures[1].from_from_to.translation, kAside.translation);
  for (const Edge& edge : problem.odometry) {
    const Pose step = problem.keyframes[edge.from].world_from_body.inverse() *
                      problem.keyframes[edge.to].world_from_body;
    EXPECT_POSE_NEAR(edge.from_from_to, step, 1e-9, 1e-9);
  }
}

TEST(PoseGraphDataset, HoldsFixedVerticesAndAnchorsPriors) {
  const TemporaryFolder scratch;
  PoseGraph graph = small_graph(true);
  graph.fixed = {2, 9, 15};
  write_g2o(scratch.path() / "held.g2o", graph);
  std::ofstream(scratch.path() / "held.g2o", std::ios::app)
      << "EDGE_SE3_PRIOR 111 1 2 3 0 0 0 1 4 0 0 0 0 0 4 0 0 0 0 4 0 0 0 1 0 0 1 0 1\n";
  PoseGraphOptions options = every(10);
  options.path = "held.g2o";
  const Sequence loaded = load_pose_graph(options, {{scratch.path()}});
  const Problem& problem = loaded.problem;
  ASSERT_EQ(loaded.provenance.fixed.size(), 3u);
  EXPECT_EQ(problem.ids[loaded.provenance.fixed[1]], 109);
  EXPECT_EQ(problem.closures.size(), 3u + 2u);
  EXPECT_EQ(loaded.false_closures, std::nullopt);  // nobody knows
  ASSERT_EQ(loaded.provenance.held.size(), 2u);
  for (const Edge& held : loaded.provenance.held) {
    EXPECT_EQ(problem.ids[held.from], 102);
    EXPECT_POSE_NEAR(problem.keyframes[held.from].world_from_body * held.from_from_to,
                     problem.keyframes[held.to].world_from_body,
                     1e-9,
                     1e-9);
  }
  ASSERT_EQ(problem.anchors.size(), 1u);
  EXPECT_EQ(problem.ids[problem.anchors[0].keyframe], 111);
  ASSERT_EQ(loaded.provenance.notes.size(), 2u);
}

TEST(PoseGraphDataset, ChainsOdometryWithoutVertices) {
  const Problem chained = derive_problem(small_graph(false), every(4), "g");
  const Problem given = derive_problem(small_graph(true), every(4), "g");
  ASSERT_EQ(chained.keyframes.size(), given.keyframes.size());
  for (std::size_t i = 0; i < given.keyframes.size(); ++i) {
    EXPECT_POSE_NEAR(
        chained.keyframes[i].world_from_body, given.keyframes[i].world_from_body, 1e-9, 1e-9);
  }
}

TEST(PoseGraphDataset, TakesNoneOrAFewClosures) {
  PoseGraphOptions options = every(10);
  options.closures_max = 1;
  const Problem one = derive_problem(small_graph(true), options, "g");
  ASSERT_EQ(one.closures.size(), 1u);
  EXPECT_DOUBLE_EQ(one.keyframes[one.closures[0].to].stamp, 11.7);  // the longest loop
  EXPECT_EQ(one.keyframes.size(), 5u);
  options.closures = GraphClosures::none;
  const Problem none = derive_problem(small_graph(true), options, "g");
  EXPECT_TRUE(none.closures.empty());
  EXPECT_EQ(none.keyframes.size(), 3u);
}

TEST(PoseGraphDataset, DropsPlaceholdersOnlyWhenTold) {
  PoseGraph graph = small_graph(true);
  graph.edges.push_back({2, 9, {}, Matrix6::Identity()});
  PoseGraphOptions options;
  EXPECT_EQ(derive_problem(graph, options, "g").closures.size(), 4u);
  options.skip_placeholders = true;
  EXPECT_EQ(derive_problem(graph, options, "g").closures.size(), 3u);
}

TEST(PoseGraphDataset, KeepsOnlyListedClosures) {
  const TemporaryFolder folder;
  const auto list = folder.file("list.txt", "117 103\n\n105 112 \n");
  EXPECT_EQ(derive_problem(small_graph(true), {}, "g", list).closures.size(), 2u);
  const auto refusal = [&](const std::string& content) {
    const auto bad = folder.file("bad.txt", content);
    return refusal_of([&] { derive_problem(small_graph(true), {}, "g", bad); });
  };
  EXPECT_THAT(refusal("117 103\n104 119\n"), HasSubstr("bad.txt:2: the graph has no closure"));
  for (const char* line : {"117\n", "117 103 4\n", "117 x\n"})
    EXPECT_THAT(refusal(line), HasSubstr("bad.txt:1: "));
}

TEST(PoseGraphDataset, TakesAGraphWithAGapWhenNoPoseIsLeftOut) {
  PoseGraph gap = small_graph(true);
  gap.edges.erase(gap.edges.begin() + 6);
  const Problem problem = derive_problem(gap, every(1), "gap.g2o");
  check(problem, "gap");
  ASSERT_EQ(problem.odometry.size(), 18u);
  EXPECT_EQ(problem.odometry[5].from, 5u);
  EXPECT_EQ(problem.odometry[6].from, 7u);
}

TEST(PoseGraphDataset, AddsFalseClosuresBySeed) {
  PoseGraphOptions options;
  const auto closures = [&](double share, std::int64_t seed) {
    options.false_closures = {share, seed};
    std::vector<std::pair<std::size_t, std::size_t>> out;
    for (const Edge& edge : derive_problem(small_graph(true), options, "g").closures) {
      out.emplace_back(edge.from, edge.to);
    }
    return out;
  };
  const auto added = closures(0.5, 1);
  EXPECT_EQ(added.size(), 6u);
  for (const auto& ends : closures(0.0, 1)) EXPECT_EQ(std::ranges::count(added, ends), 1);
  EXPECT_EQ(added, closures(0.5, 1));
  EXPECT_NE(added, closures(0.5, 2));
}

TEST(PoseGraphDataset, ReadsInformationOfAnglesAsWritten) {
  const TemporaryFolder folder;
  const auto file = folder.file(
      "one.g2o", "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 4 0 0 0 0 0 4 0 0 0 0 4 0 0 0 8 0 0 8 0 8\n");
  EXPECT_EQ(read_g2o(file).edges[0].information(5, 5), 2.0);
  EXPECT_EQ(read_g2o(file, {RotationInformation::angles}).edges[0].information(5, 5), 8.0);
  EXPECT_EQ(read_g2o(file, {RotationInformation::angles}).edges[0].information(0, 0), 4.0);
}

TEST(PoseGraphDataset, RefusesGapsAndBlindEdges) {
  PoseGraph gap = small_graph(true);
  gap.edges.erase(gap.edges.begin() + 6);
  EXPECT_THAT(refusal_of([&] { derive_problem(gap, every(2), "gap.g2o"); }),
              HasSubstr("gap.g2o: found no edge between 106 and 107"));
  PoseGraph blind = small_graph(true);
  blind.edges[8].information.setZero();
  EXPECT_THAT(refusal_of([&] { derive_problem(blind, {}, "blind.g2o"); }),
              HasSubstr("blind.g2o:9: the information matrix is not positive definite"));
  PoseGraph knot = small_graph(true);
  knot.edges[20].from = knot.edges[20].to;
  EXPECT_THAT(refusal_of([&] { derive_problem(knot, {}, "knot.g2o"); }), HasSubstr("knot.g2o:21"));
}

constexpr const char* kSquare =
    "EDGE_SE2 0 1 1 0 1.5707963267948966 1 0 0 1 0 1\n"
    "EDGE_SE2 1 2 1 0 1.5707963267948966 1 0 0 1 0 1\n"
    "EDGE_SE2 2 3 1 0 1.5707963267948966 1 0 0 1 0 1\n"
    "EDGE_SE2 3 0 1.1 0 1.5707963267948966 1 0 0 1 0 1\n";

Sequence load(const std::filesystem::path& folder, const Params& given) {
  return load_dataset("pose_graph", given, {{folder}});
}

TEST(PoseGraphDataset, LoadsAPlanarGraphWithATruthOfEdges) {
  const TemporaryFolder folder;
  folder.file("square/vo.g2o", kSquare);
  folder.file("square/gt.g2o", kSquare);
  const Sequence sequence =
      load(folder.path(), {{"path", "square/vo.g2o"}, {"truth", "square/gt.g2o"}, {"period", 0.5}});
  EXPECT_EQ(sequence.name, "square_vo");
  EXPECT_TRUE(sequence.problem.planar);
  EXPECT_EQ(sequence.provenance.closures, "edges of vo.g2o (1)");
  EXPECT_FALSE(sequence.provenance.oracle_closures);
  ASSERT_EQ(sequence.reference.size(), 4u);
  EXPECT_DOUBLE_EQ(sequence.reference[3].stamp, 1.5);
  EXPECT_TRUE(sequence.reference[3].world_from_body.translation.isApprox(Vector3(0, 1, 0), 1e-9));
  ASSERT_EQ(sequence.problem.closures.size(), 1u);
  EXPECT_EQ(sequence.problem.closures[0].from, 0u);
}

TEST(PoseGraphDataset, ClosuresSelectedByATrueListAreOracles) {
  const TemporaryFolder folder;
  folder.file("vo.g2o", kSquare);
  folder.file("true.txt", "3 0\n");
  Params given{{"path", "vo.g2o"}, {"closures.true_list", "true.txt"}};
  const Sequence sequence = load(folder.path(), given);
  EXPECT_TRUE(sequence.provenance.oracle_closures);
  EXPECT_EQ(sequence.provenance.closures,
            "edges of vo.g2o (1), only those that are true according to true.txt");
  given["closures.source"] = "none";
  EXPECT_FALSE(load(folder.path(), given).provenance.oracle_closures);
}

TEST(PoseGraphDataset, TurnsKittiCameraTruthIntoVehicleAxes) {
  const TemporaryFolder folder;
  folder.file("vo.g2o", kSquare);
  // A camera that moves forward (z) and rotates left: a negative rotation about y, which points
  // down.
  folder.file("gt.txt",
              "1 0 0 0 0 1 0 0 0 0 1 0\n"
              "0 0 -1 0 0 1 0 0 1 0 0 1\n"
              "-1 0 0 -1 0 1 0 0 0 0 -1 1\n"
              "0 0 1 -1 0 1 0 0 -1 0 0 0\n");
  const Sequence sequence = load(
      folder.path(), {{"path", "vo.g2o"}, {"truth", "gt.txt"}, {"truth_axes", "kitti_camera"}});
  ASSERT_EQ(sequence.reference.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_POSE_NEAR(sequence.reference[i].world_from_body,
                     sequence.problem.keyframes[i].world_from_body,
                     1e-9,
                     1e-9)
        << i;
  }
}

TEST(PoseGraphDataset, RefusesATruthOfAnotherLength) {
  const TemporaryFolder folder;
  folder.file("vo.g2o", kSquare);
  folder.file("gt.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  folder.file("gt.g2o",
              "EDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n"
              "EDGE_SE2 2 3 1 0 0 1 0 0 1 0 1\n"
              "EDGE_SE2 3 4 1 0 0 1 0 0 1 0 1\n");
  const auto refusal = [&](const std::string& file) {
    return refusal_of([&] { load(folder.path(), {{"path", "vo.g2o"}, {"truth", file}}); });
  };
  EXPECT_THAT(refusal("gt.txt"), HasSubstr("gt.txt: found 1 poses, expected 4"));
  EXPECT_THAT(refusal("gt.g2o"), HasSubstr("expected the ids of the graph"));
  EXPECT_THAT(refusal("none.g2o"), HasSubstr("no such file"));
}

}  // namespace
}  // namespace loopbench::pose_graph_dataset_test
