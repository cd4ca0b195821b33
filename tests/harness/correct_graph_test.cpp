// Pose graphs corrected by the command `correct`.
#include <gtest/gtest.h>

#include "datasets/derive/problem_graph.hpp"
#include "datasets/formats/g2o.hpp"
#include "tests/support/command.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::correct_graph_test {

using namespace methods;
using namespace harness;

namespace {

TEST(CorrectGraph, KeepsItsIdsAndEdges) {
  const TemporaryFolder folder;
  const Trajectory truth = test::hand_held_truth(12);
  const Problem problem =
      test::drifting(truth, twist({0.02, 0.0, 0.0}, {0.0, 0.0, 0.01}), {{0, 11}});
  std::vector<std::int64_t> ids(12);
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = 100 + static_cast<std::int64_t>(i);
  write_g2o(folder.path() / "in.g2o", problem_graph(problem, problem.keyframes, ids));
  const CommandResult done = loopbench_command("correct --method dual in.g2o -o out.g2o", folder);
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const PoseGraph before = read_g2o(folder.path() / "in.g2o");
  const PoseGraph after = read_g2o(folder.path() / "out.g2o");
  EXPECT_EQ(after.ids, ids);
  ASSERT_EQ(after.edges.size(), before.edges.size());
  for (std::size_t i = 0; i < before.edges.size(); ++i) {
    EXPECT_EQ(after.edges[i].information, before.edges[i].information);
    EXPECT_EQ(after.edges[i].from_from_to.translation, before.edges[i].from_from_to.translation);
  }
  EXPECT_NE(after.vertices.back().translation, before.vertices.back().translation);
}

// As in cubicle.g2o: terms of x and yaw at z and roll.
TEST(CorrectGraph, IndefiniteInformationIsTreatedAsStated) {
  const TemporaryFolder folder;
  folder.file("in.g2o",
              "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 4 0 0 0 0 0 4 0 0 0 0 2 3 -1 0 2 0 0 2 0 9\n"
              "EDGE_SE3:QUAT 1 2 1 0 0 0 0 0 1 4 0 0 0 0 0 4 0 0 0 0 4 0 0 0 8 0 0 8 0 8\n"
              "EDGE_SE3:QUAT 0 2 2.1 0 0 0 0 0 1 4 0 0 0 0 0 4 0 0 0 0 4 0 0 0 8 0 0 8 0 8\n");
  EXPECT_EQ(loopbench_command("correct in.g2o", folder).exit_code, 2);
  const CommandResult done =
      loopbench_command("correct in.g2o --set indefinite=repair -o out.g2o", folder);
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(read_g2o(folder.path() / "out.g2o").edges.size(), 3u);
  const CommandResult doctor = loopbench_command("doctor in.g2o", folder);
  EXPECT_EQ(doctor.exit_code, 1);
  EXPECT_NE(doctor.out.find("information_indefinite: the information of 1 of 3 edges"),
            std::string::npos)
      << doctor.out << doctor.err;
}

}  // namespace
}  // namespace loopbench::correct_graph_test
