/// Findings of `doctor` in `eval`, `run` and `correct`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "datasets/core/mirrored.hpp"
#include "datasets/derive/problem_graph.hpp"
#include "datasets/formats/formats.hpp"
#include "datasets/formats/g2o.hpp"
#include "tests/support/command.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::doctor_notes_test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

void reorder_quaternion(StampedPose& p) {
  const Rotation q = p.world_from_body.rotation;
  p.world_from_body.rotation = Rotation(q.z(), q.w(), q.x(), q.y());
}

class DoctorNotes : public testing::Test {
 protected:
  DoctorNotes() {
    const Problem problem =
        test::drifting(truth_, twist({0.004, 0, 0.001}, {0, 0.001, 0.002}), {{0, 90}, {1, 91}});
    write("gt.txt", truth_);
    write("est.txt", problem.keyframes);
    write("late.txt", changed(problem.keyframes, [](StampedPose& p) { p.stamp += 0.4; }));
    write("small.txt",
          changed(problem.keyframes, [](StampedPose& p) { p.world_from_body.translation *= 0.4; }));
    write("wxyz.txt", changed(problem.keyframes, reorder_quaternion));
    loops(problem);
  }

  void write(const std::string& name, const Trajectory& poses) {
    write_tum(folder_.path() / name, poses);
  }

  template <class Change>
  static Trajectory changed(Trajectory poses, Change change) {
    for (StampedPose& pose : poses) change(pose);
    return poses;
  }

  void loops(const Problem& problem) { folder_.file("loops.txt", test::closure_lines(problem)); }

  CommandResult doctor(const std::string& arguments) const {
    return loopbench_command("doctor " + arguments, folder_);
  }

  CommandResult run(const std::string& estimate, const std::string& protocol, const char* methods) {
    folder_.file("c.yaml",
                 "datasets: [{dataset: trajectory, label: mine, estimate: " + estimate +
                     ", reference: gt.txt, closures: {source: file, file: loops.txt}}]\nmethods: " +
                     methods + "\nmetrics: [ate]\nprotocol: " + protocol + "\n");
    return loopbench_command("run c.yaml --fresh --out r", folder_);
  }

  const Trajectory truth_ = test::hand_held_truth(120);
  TemporaryFolder folder_;
};

TEST_F(DoctorNotes, EvalNotesWhatItsOptionsLeave) {
  const char* const kOffset = "--offset -0\\.(3[6-9]|4[0-4])";
  const auto eval = [&](const std::string& arguments) {
    return loopbench_command("eval gt.txt " + arguments, folder_).out;
  };
  EXPECT_THAT(eval("est.txt"), Not(HasSubstr("doctor:")));
  EXPECT_THAT(eval("small.txt"), HasSubstr("note       doctor: scale: "));
  EXPECT_THAT(eval("small.txt --align sim3"), Not(HasSubstr("doctor:")));
  EXPECT_THAT(eval("small.txt -s"), Not(HasSubstr("doctor:")));
  EXPECT_THAT(eval("late.txt"), ContainsRegex(kOffset));
  EXPECT_THAT(eval("late.txt --offset -0.4"), Not(HasSubstr("doctor:")));
  EXPECT_THAT(eval("late.txt --offset -0.2"), ContainsRegex(kOffset)) << "the sum";
}

TEST_F(DoctorNotes, RepeatedStampsAreFoundAndDoNotHideOtherMistakes) {
  std::string rows;
  std::ifstream file(folder_.path() / "small.txt");
  for (std::string line; std::getline(file, line);) {
    rows += line + "\n";
    if (rows.size() > line.size() + 1 && rows.size() < 3 * line.size()) rows += line + "\n";
  }
  folder_.file("twice.txt", rows);
  const CommandResult found = doctor("gt.txt twice.txt");
  EXPECT_EQ(found.exit_code, 1) << found.err;
  EXPECT_THAT(found.out,
              HasSubstr("  repeated_stamps: twice.txt: 1 with the stamp of the pose before; "
                        "--repeats keep_first or keep_last"));
  EXPECT_THAT(found.out, HasSubstr("  scale: "));
  EXPECT_THAT(doctor("gt.txt twice.txt --repeats keep_last").out,
              Not(HasSubstr("repeated_stamps")));
  EXPECT_EQ(doctor("gt.txt twice.txt --repeats refuse").exit_code, 2);
}

/// Applies the command "traj transform EST ..." that `doctor` names for a changed estimate.
TEST_F(DoctorNotes, TheNamedCommandRemovesTheFinding) {
  const Trajectory estimate = read_trajectory(folder_.path() / "est.txt");
  const auto check = [&](const std::string& fault, auto change) {
    write("wrong.txt", changed(estimate, change));
    const CommandResult found = doctor("gt.txt wrong.txt");
    EXPECT_EQ(found.exit_code, 1) << found.out << found.err;
    EXPECT_THAT(found.out, HasSubstr("  " + fault + ": "));
    const std::size_t begin = found.out.find("traj transform EST");
    ASSERT_NE(begin, std::string::npos) << found.out;
    std::string command = found.out.substr(begin, found.out.find(" (", begin) - begin);
    command.replace(command.find("EST"), 3, "wrong.txt");
    successful_command(command + " -o right.txt", folder_);
    successful_command("doctor gt.txt right.txt", folder_);
  };
  check("quaternion_order", reorder_quaternion);
  check("inverted_poses", [](StampedPose& p) { p.world_from_body = p.world_from_body.inverse(); });
  check("axes", [](StampedPose& p) {
    const Vector3 t = p.world_from_body.translation;
    p.world_from_body.translation = {-t.y(), t.z(), t.x()};
  });
  check("axes", [](StampedPose& p) { p.world_from_body = mirrored(p.world_from_body, 2); });
  check("conjugated", [](StampedPose& p) {
    p.world_from_body.rotation = p.world_from_body.rotation.conjugate();
  });
  check("length_unit", [](StampedPose& p) { p.world_from_body.translation *= 1000.0; });
  check("stamp_unit", [](StampedPose& p) { p.stamp = 1000.0 * p.stamp; });
}

TEST_F(DoctorNotes, RunPrintsThemForMeasuredSequences) {
  EXPECT_THAT(run("est.txt", "loopbench", "[raw, dual]").err, Not(HasSubstr("doctor:")));
  EXPECT_THAT(run("wxyz.txt", "loopbench", "[raw]").err,
              HasSubstr("mine: doctor: quaternion_order: "));
  EXPECT_THAT(run("small.txt", "loopbench", "[raw]").err, HasSubstr("protocol: {align: sim3}"));
  EXPECT_THAT(run("small.txt", "{base: loopbench, align: sim3}", "[raw]").err,
              Not(HasSubstr("doctor: scale")));
}

TEST_F(DoctorNotes, ClosuresOfATrajectoryAreChecked) {
  Problem problem = test::drifting(truth_,
                                   twist({0.004, 0, 0.001}, {0, 0.001, 0.002}),
                                   {{0, 90}, {1, 91}, {2, 92}, {3, 93}, {4, 94}, {5, 95}, {6, 96}});
  loops(problem);
  const std::string closed = "est.txt --loops loops.txt";
  EXPECT_THAT(successful_command("doctor " + closed, folder_).out, HasSubstr("nothing found"));
  problem.closures[3].from_from_to.translation.x() += 4.5;  // false
  loops(problem);
  EXPECT_EQ(doctor(closed).exit_code, 1);
  EXPECT_THAT(doctor(closed).out, HasSubstr("closure_gap: 1 of 7 closures"));
  EXPECT_THAT(run("est.txt", "loopbench", "[raw]").err, HasSubstr("doctor: closure_gap: 1 of 7"));
  EXPECT_THAT(loopbench_command("correct " + closed + " --method dual -o c.txt", folder_).out,
              HasSubstr("note: doctor: closure_gap: 1 of 7 closures"));
}

TEST_F(DoctorNotes, FaultsOfPoseGraphsAreFound) {
  Problem good = test::drifting(truth_,
                                twist({0.004, 0, 0.001}, {0, 0.001, 0.002}),
                                {{0, 85}, {2, 87}, {4, 89}, {6, 91}, {8, 93}, {10, 95}, {12, 97}});
  const auto written = [&](const Problem& problem) {
    write_g2o(folder_.path() / "g.g2o", problem_graph(problem, problem.keyframes));
    return doctor("g.g2o");
  };
  ASSERT_EQ(written(good).exit_code, 0);
  const auto check = [&](const std::string& fault, auto change) {
    Problem wrong = good;
    change(wrong);
    const CommandResult found = written(wrong);
    EXPECT_EQ(found.exit_code, 1) << found.out << found.err;
    EXPECT_THAT(found.out, HasSubstr("  " + fault + ": "));
  };
  check("closure_direction", [](Problem& p) {
    for (Edge& edge : p.closures) edge.from_from_to = edge.from_from_to.inverse();
  });
  const CommandResult json = doctor("g.g2o --json");
  EXPECT_TRUE(nlohmann::json::accept(json.out)) << json.out;
  check("closure_gap", [](Problem& p) { p.closures[3].from_from_to.translation.x() += 4.5; });
  check("information_scale", [](Problem& p) {
    for (auto* edges : {&p.odometry, &p.closures}) {
      for (Edge& edge : *edges) edge.information *= 1e-8;
    }
  });
}

TEST_F(DoctorNotes, TheReferenceHasItsOwnFormat) {
  EXPECT_THAT(doctor("gt.txt est.txt --ref-format kitti").err, HasSubstr("gt.txt"));
  EXPECT_THAT(doctor("gt.txt est.txt --format kitti --ref-format tum").err, HasSubstr("est.txt"));
}

TEST_F(DoctorNotes, ASinglePoseIsNoCleanFile) {
  folder_.file("one.txt", "101 0 0 0 0 0 0 1\n");
  const CommandResult one = doctor("gt.txt one.txt");
  EXPECT_EQ(one.exit_code, 1);
  EXPECT_THAT(one.out, HasSubstr("not checked: units, scale, "));
  EXPECT_THAT(one.out, HasSubstr("nothing could be checked"));
  EXPECT_THAT(doctor("gt.txt est.txt").out, Not(HasSubstr("offset")));
  EXPECT_EQ(loopbench_command("eval gt.txt est.txt -a --align_origin", folder_).exit_code, 2);
}

}  // namespace
}  // namespace loopbench::doctor_notes_test
