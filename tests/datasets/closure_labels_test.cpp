/// Which closures of a sequence are known to be false: added ones, and none of those that were
/// measured in the reference; nothing is known of closures in files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "datasets/pose_graph_dataset.hpp"
#include "datasets/trajectory_dataset.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::closure_labels_test {
namespace {

using testing::IsEmpty;
using testing::Optional;

/// 41 poses from 0 to 20 m and back, one per second.
std::string there_and_back() {
  std::string out;
  for (int i = 0; i <= 40; ++i) {
    out += std::to_string(i) + " " + std::to_string(20 - std::abs(20 - i)) + " 0 0 0 0 0 1\n";
  }
  return out;
}

/// The same as a graph with a loop from 5 to 35, where vertices 2 and 30 are fixed like 0.
std::string graph() {
  std::string out;
  const auto x = [](int i) { return std::to_string(20 - std::abs(20 - i)); };
  for (int i = 0; i <= 40; ++i) {
    out += "VERTEX_SE2 " + std::to_string(i) + " " + x(i) + " 0 0\n";
  }
  for (int i = 0; i < 40; ++i) {
    out += "EDGE_SE2 " + std::to_string(i) + " " + std::to_string(i + 1) + (i < 20 ? " 1" : " -1") +
           " 0 0 100 0 0 100 0 100\n";
  }
  return out + "EDGE_SE2 5 35 0 0 0 100 0 0 100 0 100\nFIX 0\nFIX 2\nFIX 30\n";
}

/// Pairs of keyframes that closures connect.
using Pairs = std::multiset<std::pair<std::size_t, std::size_t>>;
Pairs pairs(const Problem& problem) {
  Pairs out;
  for (const Edge& edge : problem.closures) out.emplace(edge.from, edge.to);
  return out;
}

/// The planted sequence's closures without those of `given` are those that have the label.
void expect_labelled(const Sequence& given, const Sequence& planted, std::size_t count) {
  ASSERT_TRUE(planted.false_closures);
  EXPECT_EQ(planted.false_closures->size(), count);
  EXPECT_TRUE(std::ranges::is_sorted(*planted.false_closures));
  Pairs others = pairs(planted.problem);
  EXPECT_EQ(others.size(), pairs(given.problem).size() + count);
  for (const std::size_t k : *planted.false_closures) {
    const Edge& edge = planted.problem.closures.at(k);
    others.erase(others.find({edge.from, edge.to}));
  }
  EXPECT_EQ(others, pairs(given.problem));
}

TEST(ClosureLabels, OfAGraphFollowTheAddedOnesPastThoseOfFixedVertices) {
  const TemporaryFolder folder;
  folder.file("graph.g2o", graph());
  PoseGraphOptions options;
  options.path = "graph.g2o";
  const Sequence given = load_pose_graph(options, {{folder.path()}});
  EXPECT_EQ(given.problem.closures.size(), 1u + 2u);  // the loop, and two that hold vertices
  EXPECT_EQ(given.false_closures, std::nullopt);
  options.false_closures = {0.8, 1};
  expect_labelled(given, load_pose_graph(options, {{folder.path()}}), 4);
}

TEST(ClosureLabels, OfATrajectoryAreKnownOfTheReferenceAndOfAddedOnes) {
  const TemporaryFolder folder;
  folder.file("run.txt", there_and_back());
  folder.file("loops.txt", "5 35 0 0 0 0 0 0 1\n");
  TrajectoryOptions options;
  options.estimate = options.reference = "run.txt";
  options.closures = ClosureSource::reference;
  options.closures_radius = 0.5;
  const Sequence measured = load_trajectory(options, {{folder.path()}});
  EXPECT_FALSE(measured.problem.closures.empty());
  EXPECT_THAT(measured.false_closures, Optional(IsEmpty()));
  options.closures = ClosureSource::file;
  options.closures_file = "loops.txt";
  const Sequence given = load_trajectory(options, {{folder.path()}});
  EXPECT_EQ(given.problem.closures.size(), 1u);
  EXPECT_EQ(given.false_closures, std::nullopt);
  options.false_closures = {0.75, 1};
  expect_labelled(given, load_trajectory(options, {{folder.path()}}), 3);
}

}  // namespace
}  // namespace loopbench::closure_labels_test
