// `loopbench correct`: the file that it writes has the score of the same cell in a sweep.
#include "harness/eval/correct.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "datasets/derive/odometry.hpp"
#include "datasets/derive/problem_graph.hpp"
#include "datasets/formats/formats.hpp"
#include "datasets/formats/g2o.hpp"
#include "datasets/trajectory_dataset.hpp"
#include "harness/store/read.hpp"
#include "tests/support/command.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::correct_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

/// A drifting drive along a loop: est.txt, gt.txt, loops.txt and a config with the given methods.
class Correct : public testing::Test {
 protected:
  Correct() {
    const Trajectory truth = test::hand_held_truth(40);
    const Problem problem =
        test::drifting(truth, twist({0.01, 0.0, 0.004}, {0.0, 0.002, 0.01}), {{0, 38}, {1, 39}});
    write_tum(folder_.path() / "est.txt", problem.keyframes);
    write_tum(folder_.path() / "gt.txt", truth);
    folder_.file("loops.txt", test::closure_lines(problem));
  }

  CommandResult correct(const std::string& arguments) const {
    return successful_command("correct " + arguments, folder_);
  }

  /// RMSE [m] of the ATE that a sweep stores for this method.
  double in_sweep(const std::string& method, const std::string& times, const std::string& dataset) {
    folder_.file("c.yaml",
                 "datasets: [{dataset: trajectory, " + dataset +
                     ", closures: {source: file, file: loops.txt}}]\nmethods: [" + method +
                     "]\nmetrics: [ate]\ntimes: " + times + "\n");
    successful_command("run c.yaml --fresh --out r", folder_);
    for (const Record& record : read_records(folder_.path() / "r")) {
      if (record.kind->metric == "ate" && record.kind->relation == "translation")
        return record.statistics.rmse;
    }
    ADD_FAILURE() << "no ate";
    return 0.0;
  }

  /// The same of a file, by `eval`.
  double evaluated(const std::string& reference, const std::string& file) {
    const CommandResult ran =
        successful_command("eval " + reference + " " + file + " --json", folder_);
    const Json metrics = Json::parse(ran.out).at(0).at("metrics");
    for (const Json& metric : metrics) {
      if (metric["metric"] == "ate" && metric["relation"] == "translation") return metric["rmse"];
    }
    ADD_FAILURE() << "no ate";
    return 0.0;
  }

  TemporaryFolder folder_;
};

TEST_F(Correct, ItsFileHasTheScoreOfTheSweepsCell) {
  const std::string files = "estimate: est.txt, reference: gt.txt";
  for (const std::string method : {"uniform", "dual + cubic_spline"}) {
    const std::string by_method = "--method '" + method + "' est.txt --loops loops.txt ";
    const CommandResult done = correct(by_method + "-o out.txt");
    EXPECT_THAT(done.out, HasSubstr("closure residual, rms [m]"));
    EXPECT_THAT(done.out, HasSubstr("chi2 of odometry                         0 "));
    EXPECT_THAT(done.out, HasSubstr("40 poses in out.txt"));
    EXPECT_EQ(evaluated("gt.txt", "out.txt"), in_sweep(method, "keyframes", files)) << method;
    correct(by_method + "--at gt.txt -o dense.txt");
    EXPECT_EQ(evaluated("gt.txt", "dense.txt"), in_sweep(method, "dense", files)) << method;
  }
}

// The sweep scores the covariances that a method states, `correct` writes them, `eval` reads them.
TEST_F(Correct, WritesTheCovariancesThatTheSweepScores) {
  folder_.file(
      "nees.yaml",
      "datasets: [{dataset: trajectory, label: drive, estimate: est.txt, reference: gt.txt, "
      "closures: {source: file, file: loops.txt}}]\n"
      "methods: [raw, {method: dual, covariances: true}]\n"
      "metrics: [{metric: nees, gauge: origin}]\ntimes: keyframes\n");
  successful_command("run nees.yaml --out nees", folder_);
  std::map<std::string, std::vector<double>> means;
  std::string why;
  for (const Record& record : read_records(folder_.path() / "nees")) {
    if (record.status == Status::declined) {
      why = record.why;
    } else if (record.kind->relation == "nees") {
      means[record.kind->axis].push_back(record.statistics.mean);
    }
  }
  EXPECT_THAT(why, HasSubstr("states no covariances"));
  correct("est.txt --loops loops.txt --method dual:covariances=true -o out.txt");
  const CommandResult of_file =
      successful_command("eval gt.txt out.txt --metric nees:gauge=origin --json", folder_);
  const Json rows = Json::parse(of_file.out).at(0).at("metrics");
  int compared = 0;
  for (const Json& row : rows) {
    if (row["relation"] != "nees") continue;
    const double mean = row["mean"];
    ASSERT_EQ(means[row["axis"]].size(), 1U);
    EXPECT_NEAR(means[row["axis"]][0], mean, 1e-9 * mean) << row["axis"];
    ++compared;
  }
  EXPECT_EQ(compared, 3);
}

TEST_F(Correct, TheOpenRunOfFr1RoomHasTheScoreOfTheSweepsCell) {
  const char* data = std::getenv("LOOPBENCH_DATA");
  if (data == nullptr) GTEST_SKIP() << "LOOPBENCH_DATA is not set";
  const std::string room = std::string(data) + "/tum_rgbd/fr1_room/";
  if (!std::filesystem::exists(room)) GTEST_SKIP() << room << " is absent";
  TrajectoryOptions options;
  options.estimate = room + "orbslam2_rgbd_open_keyframes.txt";
  options.closures = ClosureSource::estimate;
  options.closures_file = room + "orbslam2_rgbd_closed_frames_run1.txt";
  folder_.file("loops.txt", test::closure_lines(load_trajectory(options, DataRoot{{"/"}}).problem));
  const std::string files =
      "estimate: " + options.estimate + ", reference: " + room + "groundtruth.txt";
  correct("--method uniform " + options.estimate + " --loops loops.txt -o out.txt");
  EXPECT_EQ(evaluated(room + "groundtruth.txt", "out.txt"),
            in_sweep("uniform", "keyframes", files));
}

TEST_F(Correct, JsonStatesResidualsBeforeAndAfter) {
  const Json json =
      Json::parse(correct("--method pose_graph:loss=huber est.txt --loops loops.txt --json").out);
  EXPECT_EQ(json["keyframes"], 40);
  EXPECT_EQ(json["closures"], 2);
  EXPECT_EQ(json["rejected"], nullptr);
  EXPECT_GT(json["counts"]["iterations"], 0.0);
  for (const auto& [name, value] : json["counts"].items()) {
    EXPECT_THAT(name, testing::Not(HasSubstr("before"))) << "is that of the input elsewhere";
  }
  EXPECT_THAT(correct("est.txt --loops loops.txt").out, HasSubstr("\ncounts: iterations "));
  EXPECT_LT(json["after"]["translation_rms"], json["before"]["translation_rms"]);
  EXPECT_NEAR(json["before"]["chi2_odometry"], 0.0, 1e-12) << "a trajectory agrees with itself";
}

TEST_F(Correct, RejectedClosuresAreCounted) {
  const Json json = Json::parse(correct("--method dual_pcm est.txt --loops loops.txt --json").out);
  EXPECT_EQ(json["rejected"], 2.0 - json["counts"]["closures_consistent"].get<double>());
}

TEST_F(Correct, MeasuredPositionsAreAnchors) {
  std::string points;
  const Trajectory truth = read_trajectory(folder_.path() / "gt.txt");
  for (std::size_t i = 0; i < truth.size(); i += 4) {
    points += to_text(truth[i].stamp);
    for (const double x : truth[i].world_from_body.translation) points += " " + to_text(x + 7.0);
    points += " 0.001\n";
  }
  folder_.file("points.txt", points + "1e6 0 0 0 1\n");
  const Json json =
      Json::parse(correct("--method dual est.txt --anchors points.txt -o out.txt --json").out);
  EXPECT_EQ(json["anchors"], 10);
  EXPECT_GT(json["before"]["anchor_rms"], 7.0) << "another world";
  EXPECT_LT(json["after"]["anchor_max"], 0.01);
  EXPECT_THAT(json["notes"][0].get<std::string>(), HasSubstr("points.txt: 1 of 11 positions"));
  EXPECT_LT(evaluated("gt.txt", "out.txt"), 0.5 * evaluated("gt.txt", "est.txt"));
  const std::string anchored = "correct est.txt --anchors points.txt ";
  const CommandResult declined = loopbench_command(anchored + "--method elch", folder_);
  EXPECT_EQ(declined.exit_code, 2);
  EXPECT_THAT(declined.err, HasSubstr("anchors (10), which the method does not use"));
  EXPECT_THAT(loopbench_command(anchored + "-o out.g2o", folder_).err, HasSubstr("no anchors"));
}

TEST_F(Correct, StartEqualsEndNeedsNoMeasuredPose) {
  correct("--method uniform est.txt --start-equals-end 0.01 -o out.txt");
  const Trajectory out = read_trajectory(folder_.path() / "out.txt");
  EXPECT_NEAR(
      (out.back().world_from_body.translation - out.front().world_from_body.translation).norm(),
      0.0,
      1e-9);
}

TEST_F(Correct, WritesOtherFormatsAndStandardOutput) {
  const std::string input = "est.txt --loops loops.txt ";
  correct(input + "-o out.txt");
  correct(input + "--method pose_graph -o same.txt");
  const std::string poses = read_all(folder_.path() / "out.txt");
  EXPECT_EQ(poses, read_all(folder_.path() / "same.txt")) << "the default is pose_graph";
  const CommandResult printed = correct(input + "-o -");
  EXPECT_EQ(printed.out, poses);
  EXPECT_THAT(printed.err, HasSubstr("corrected by pose_graph"));
  for (const char* format : {"kitti", "euroc"}) {
    const std::string name = std::string("out.") + format;
    const CommandResult done = correct(input + "-o " + name + " --to " + format);
    EXPECT_EQ(read_trajectory(folder_.path() / name).size(), 40u) << format;
    const bool is_noted = done.out.find("note: kitti does not contain stamps\n") < done.out.size();
    EXPECT_EQ(is_noted, name == "out.kitti");
  }
}

TEST_F(Correct, ReadsTheLoopsOfAGraphOfTheSamePoses) {
  Problem problem;
  problem.keyframes = read_trajectory(folder_.path() / "est.txt");
  problem.odometry = odometry_edges(problem.keyframes, EdgeNoise{});
  problem.closures = {{1, 39, Pose{{1, 0, 0, 0}, {0.5, 0, 0}}, Matrix6::Identity()}};
  write_g2o(folder_.path() / "loops.g2o", problem_graph(problem, problem.keyframes, {}));
  const std::string input = "est.txt --method uniform --json --loops ";
  const Json all = Json::parse(correct(input + "loops.g2o").out);
  EXPECT_EQ(all["closures"], 1);
  folder_.file("only.g2o",
               "EDGE_SE3:QUAT 1 39 0.5 0 0 0 0 0 1 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 4 0 0 4 0 4\n");
  EXPECT_EQ(Json::parse(correct(input + "only.g2o").out)["after"], all["after"]);
  folder_.file("far.g2o",
               "EDGE_SE3:QUAT 1 40 0.5 0 0 0 0 0 1 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 4 0 0 4 0 4\n");
  EXPECT_THAT(loopbench_command("correct " + input + "far.g2o", folder_).err,
              HasSubstr("far.g2o:1: found vertex 40, expected 0 to 39"));
}

TEST_F(Correct, AGraphKeepsItsIdsAndEdges) {
  const Trajectory truth = test::hand_held_truth(12);
  const Problem problem =
      test::drifting(truth, twist({0.02, 0.0, 0.0}, {0.0, 0.0, 0.01}), {{0, 11}});
  std::vector<std::int64_t> ids(12);
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = 100 + static_cast<std::int64_t>(i);
  write_g2o(folder_.path() / "in.g2o", problem_graph(problem, problem.keyframes, ids));
  correct("--method dual in.g2o -o out.g2o");
  const PoseGraph before = read_g2o(folder_.path() / "in.g2o");
  const PoseGraph after = read_g2o(folder_.path() / "out.g2o");
  EXPECT_EQ(after.ids, ids);
  ASSERT_EQ(after.edges.size(), before.edges.size());
  for (std::size_t i = 0; i < before.edges.size(); ++i) {
    EXPECT_EQ(after.edges[i].information, before.edges[i].information);
    EXPECT_EQ(after.edges[i].from_from_to.translation, before.edges[i].from_from_to.translation);
  }
  EXPECT_NE(after.vertices.back().translation, before.vertices.back().translation);
}

// As in cubicle.g2o: terms of x and yaw at z and roll.
TEST_F(Correct, IndefiniteInformationOfAGraphIsTreatedAsStated) {
  folder_.file("in.g2o",
               "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 4 0 0 0 0 0 4 0 0 0 0 2 3 -1 0 2 0 0 2 0 9\n"
               "EDGE_SE3:QUAT 1 2 1 0 0 0 0 0 1 4 0 0 0 0 0 4 0 0 0 0 4 0 0 0 8 0 0 8 0 8\n"
               "EDGE_SE3:QUAT 0 2 2.1 0 0 0 0 0 1 4 0 0 0 0 0 4 0 0 0 0 4 0 0 0 8 0 0 8 0 8\n");
  EXPECT_EQ(loopbench_command("correct in.g2o", folder_).exit_code, 2);
  correct("in.g2o --set indefinite=repair -o out.g2o");
  EXPECT_EQ(read_g2o(folder_.path() / "out.g2o").edges.size(), 3u);
  const CommandResult doctor = loopbench_command("doctor in.g2o", folder_);
  EXPECT_EQ(doctor.exit_code, 1);
  EXPECT_THAT(doctor.out, HasSubstr("information_indefinite: the information of 1 of 3 edges"));
}

TEST_F(Correct, BadArgumentsAreNamed) {
  const auto error = [&](const std::string& arguments) {
    const CommandResult done = loopbench_command("correct " + arguments, folder_);
    EXPECT_EQ(done.exit_code, 2) << done.out;
    return done.err;
  };
  EXPECT_THAT(error("--method unifrom est.txt"), HasSubstr("did you mean 'uniform'?"));
  EXPECT_THAT(error("--method uniform:wights=time est.txt"), HasSubstr("wights: unknown option"));
  EXPECT_THAT(error("--method uniform:weights est.txt"), HasSubstr("expected NAME:option=value"));
  EXPECT_THAT(error("est.txt"),
              HasSubstr("declines: the problem has no loop closures, expected --loops"));
  EXPECT_THAT(error("--method uniform absent.txt"), HasSubstr("absent.txt"));
  EXPECT_THAT(error("--method dual est.txt --loops loops.txt -o est.txt"), HasSubstr("est.txt"));
  EXPECT_THAT(error("--method dual est.txt --loops loops.txt --set a=1"), HasSubstr("a: unknown"));
  EXPECT_THAT(error("est.txt --set a=1 --set a=2"),
              HasSubstr("a: is set to 1 by --set and to 2 by --set"));
}

}  // namespace
}  // namespace loopbench::correct_test
