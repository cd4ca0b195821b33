#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "datasets/core/error.hpp"
#include "datasets/core/params.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/judgement.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench {
namespace {

using Json = nlohmann::json;

std::string golden(const std::string& name) {
  return std::string(LOOPBENCH_TEST_DATA) + "/golden/" + name;
}

/// What `loopbench eval ARGS` prints.
std::string eval(std::vector<std::string> arguments) {
  CLI::App app;
  int exit_code = -1;
  add_eval(app, exit_code);
  arguments.insert(arguments.begin(), "eval");
  std::reverse(arguments.begin(), arguments.end());  // CLI11 wants them so
  testing::internal::CaptureStdout();
  try {
    app.parse(arguments);
  } catch (...) {
    testing::internal::GetCapturedStdout();
    throw;
  }
  EXPECT_EQ(exit_code, kExitOk);
  return testing::internal::GetCapturedStdout();
}

Json eval_json(std::vector<std::string> arguments) {
  arguments.push_back("--json");
  return Json::parse(eval(std::move(arguments)));
}

template <class Error>
std::string refusal(const std::vector<std::string>& arguments) {
  try {
    eval(arguments);
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing thrown";
  return "";
}

Json find(const Json& judged, const std::string& metric, const std::string& relation) {
  for (const Json& row : judged["metrics"]) {
    if (row["metric"] == metric && row["relation"] == relation && row["axis"] == "3d") return row;
  }
  ADD_FAILURE() << "no " << metric << " " << relation;
  return {};
}

// Values of golden.json, evo APE translation_part at max_diff 0.01.
TEST(Eval, EqualsEvoUnderEvosAssociation) {
  const auto judged = [](const std::string& align) {
    return eval_json({golden("gt.txt"),
                      golden("est_drift.txt"),
                      "--association=evo",
                      "--max-diff=0.01",
                      "--align=" + align});
  };
  const Json se3 = judged("se3");
  EXPECT_EQ(se3["pairs"], 635);
  EXPECT_EQ(se3["alignment"]["type"], "se3");
  EXPECT_NEAR(find(se3, "ate", "translation")["rmse"], 0.676208260682124, 1e-12);
  EXPECT_NEAR(find(se3, "rpe", "translation")["rmse"], 0.0269779727282208, 1e-12);
  const Json sim3 = judged("sim3");
  EXPECT_NEAR(sim3["alignment"]["scale"], 0.9848728953975282, 1e-12);
  EXPECT_NEAR(find(sim3, "ate", "translation")["rmse"], 0.660473127811482, 1e-12);
  EXPECT_NEAR(find(judged("none"), "ate", "translation")["rmse"], 12.6565235225568, 1e-10);
  EXPECT_NEAR(find(judged("origin"), "ate", "translation")["rmse"], 2.12100433850654, 1e-11);
}

TEST(Eval, JsonHasThePromisedKeys) {
  const Json judged = eval_json({golden("gt.txt"), golden("est_corrected.txt")});
  for (const char* key : {"reference",
                          "estimate",
                          "protocol",
                          "pairs",
                          "possible",
                          "coverage",
                          "span",
                          "alignment",
                          "diagnosis",
                          "metrics",
                          "undefined"}) {
    EXPECT_TRUE(judged.contains(key)) << key;
  }
  EXPECT_EQ(judged["coverage"].get<double>(),
            judged["pairs"].get<double>() / judged["possible"].get<double>());
  std::map<std::string, int> rows;
  for (const Json& row : judged["metrics"]) {
    ++rows[row["metric"]];
    for (const char* key : {"metric",
                            "relation",
                            "axis",
                            "unit",
                            "rmse",
                            "mean",
                            "median",
                            "std",
                            "min",
                            "max",
                            "count"}) {
      EXPECT_TRUE(row.contains(key)) << key;
    }
  }
  // rpe: 1 frame, 1 s, 1 m; five rows each. segments: all lengths together.
  EXPECT_EQ(
      rows,
      (std::map<std::string, int>{{"ate", 2}, {"axis_error", 3}, {"rpe", 15}, {"segments", 2}}));
}

TEST(Eval, DiagnosesWhatItWasGiven) {
  const Json judged = eval_json({golden("gt.txt"), golden("est_corrected.txt")});
  EXPECT_EQ(judged["diagnosis"]["matched"], 635.0);
  EXPECT_EQ(judged["diagnosis"]["position_only_reference"], 0.0);
  EXPECT_NE(eval({golden("gt.txt"), golden("est_corrected.txt")})
                .find("\ndiagnosis  matched 635, possible 657, largest_gap 1.86 s, repeated 0,\n"),
            std::string::npos);
}

TEST(Eval, RefusesRotationOfPositionsAlone) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "positions.txt").string();
  {
    std::ofstream out(file);
    for (int i = 0; i < 20; ++i) out << i << " " << i << " " << i * i << " 0 0 0 0 1\n";
  }
  const Json judged = eval_json({file, file});
  EXPECT_EQ(find(judged, "ate", "translation")["count"], 20);
  EXPECT_EQ(judged["undefined"][0]["metric"], "ate");
  EXPECT_EQ(judged["undefined"][0]["relation"], "rotation");
  EXPECT_NE(
      eval({file, file}).find("ate           rotation    3d   undefined: the reference keeps"),
      std::string::npos);
}

TEST(Eval, SeveralEstimatesAreSeveralJudgements) {
  const Json judged =
      eval_json({golden("gt.txt"), golden("est_drift.txt"), golden("est_corrected.txt")});
  ASSERT_TRUE(judged.is_array());
  ASSERT_EQ(judged.size(), 2u);
  EXPECT_EQ(judged[1]["estimate"], golden("est_corrected.txt"));
}

TEST(Eval, PairsKittiPosesByTheirNumber) {
  const Json judged = eval_json({golden("kitti_gt.txt"), golden("kitti_est.txt")});
  EXPECT_EQ(judged["pairs"], 1200);
  EXPECT_EQ(judged["coverage"], 1.0);
}

TEST(Eval, TimesBelongToWhicheverFileIsKitti) {
  const TemporaryFolder folder;
  const std::string times = (folder.path() / "times.txt").string();
  {
    std::ofstream out(times);
    for (int i = 0; i < 1200; ++i) out << 1000.0 + 0.5 * i << "\n";
  }
  const Json judged =
      eval_json({golden("kitti_gt.txt"), golden("kitti_est.txt"), "--times=" + times});
  EXPECT_EQ(judged["pairs"], 1200);
  for (const Json& row : judged["metrics"]) {
    // 0.5 s apart, so 1 s is two poses on.
    const bool is_second = row["options"] == Json{{"delta", 1.0}, {"unit", "s"}};
    if (is_second) {
      EXPECT_EQ(row["count"], 1198);
    }
  }
  const std::string why =
      refusal<InputError>({golden("gt.txt"), golden("est_drift.txt"), "--times=" + times});
  EXPECT_EQ(why, times + ": is a times file, but no file here is KITTI poses");
}

TEST(Eval, PrintsATableForPeople) {
  const std::string got =
      eval({golden("gt.txt"), golden("est_drift.txt"), "--association=evo", "--max-diff=0.01"});
  EXPECT_NE(got.find("pairs      635 of 657 (96.7 %), over 100.0 % of the reference's time\n"),
            std::string::npos)
      << got;
  EXPECT_NE(got.find("ate           translation 3d   m         0.676208 "), std::string::npos)
      << got;
}

TEST(Eval, AnUndefinedMetricSaysWhyAndTheOthersStand) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "short.txt").string();
  std::ofstream(file) << "0 0 0 0 0 0 0 1\n0.1 0.1 0 0 0 0 0 1\n0.2 0 0.1 0 0 0 0 1\n";
  const Json judged = eval_json({file, file});
  EXPECT_EQ(find(judged, "ate", "translation")["count"], 3);
  ASSERT_EQ(judged["undefined"].size(), 2u);  // rpe over 1 s and over 1 m
  EXPECT_EQ(judged["undefined"][0]["why"], "rpe: none of 3 poses is 1.0 s before another");
  EXPECT_NE(eval({file, file}).find("rpe 1 m       undefined: rpe: none of 3"), std::string::npos);
}

double rmse(const std::vector<std::string>& options, const std::string& metric) {
  std::vector<std::string> arguments{golden("gt.txt"), golden("est_drift.txt"), "--protocol=evo"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Json judged = eval_json(arguments);
  for (const Json& row : judged["metrics"]) {
    if (row["metric"] == metric && row["axis"] == "3d") return row["rmse"];
  }
  ADD_FAILURE() << "no " << metric;
  return 0.0;
}

// Values of golden.json.
TEST(Eval, KnowsEvosHabits) {
  EXPECT_NEAR(rmse({}, "ate"), 12.6565235225568, 1e-10);
  EXPECT_NEAR(rmse({"-a"}, "ate"), 0.676208260682124, 1e-12);
  EXPECT_NEAR(rmse({"-as"}, "ate"), 0.660473127811482, 1e-12);
  EXPECT_NEAR(rmse({"--align", "--correct_scale"}, "ate"), 0.660473127811482, 1e-12);
  EXPECT_NEAR(rmse({"-a", "--n_to_align=100"}, "ate"), 1.69629979000945, 1e-11);
  EXPECT_NEAR(
      rmse({"-a", "--t_max_diff=0.003", "--t_offset=-0.004"}, "ate"), 0.676336104623048, 1e-12);
  EXPECT_NEAR(rmse({"-r", "full"}, "ape"), 12.783012299976825, 1e-10);
  EXPECT_NEAR(rmse({"-r", "trans_part", "-d", "1", "-u", "m"}, "rpe"), 0.0772624810704977, 1e-12);
  EXPECT_NEAR(rmse({"-d", "1", "-u", "m", "--all_pairs"}, "rpe"), 0.064717408609261, 1e-12);
  EXPECT_NEAR(rmse({"-d", "1", "-u", "m", "--all_pairs", "--pairs_from_reference"}, "rpe"),
              0.0680704819728785,
              1e-12);
  EXPECT_NEAR(rmse({"-d", "10", "-u", "d", "--all_pairs"}, "rpe"), 1.66822987421266, 1e-11);
}

TEST(Eval, TellsTheProtocolInFull) {
  const Json judged = eval_json({golden("gt.txt"),
                                 golden("est_drift.txt"),
                                 "--protocol=evo",
                                 "--align=origin",
                                 "--set=ddof=1"});
  const Json& protocol = judged["protocol"];
  EXPECT_EQ(protocol["name"], "evo");
  EXPECT_EQ(protocol["version"], "26d0953");
  EXPECT_EQ(protocol["changes"], (Json{{"align", "origin"}, {"ddof", 1}}));
  EXPECT_EQ(protocol["rules"]["association"], "evo");
  EXPECT_EQ(judged["alignment"]["type"], "origin");
}

TEST(Eval, SeveralProtocolsAndEstimatesAreATable) {
  const std::string got = eval({golden("gt.txt"),
                                golden("est_drift.txt"),
                                golden("est_corrected.txt"),
                                "--protocol=tum,rpg"});
  EXPECT_NE(got.find("tum [evo 26d0953, test/tum_benchmark_tools], rmse against "),
            std::string::npos);
  EXPECT_NE(got.find("rpg [8c8ceec], rmse against "), std::string::npos);
  EXPECT_NE(got.find("ate translation [m]"), std::string::npos);
  EXPECT_NE(got.find("est_corrected.txt"), std::string::npos);
  EXPECT_EQ(eval_json({golden("gt.txt"), golden("est_drift.txt"), "--protocol=tum,rpg"}).size(),
            2u);
}

TEST(Eval, CsvHoldsALinePerScoreInFull) {
  const std::string got =
      eval({golden("gt.txt"), golden("est_drift.txt"), "--protocol=evo", "-a", "--csv"});
  EXPECT_NE(got.find("evo (align=se3),26d0953,ate,,translation,3d,m,635,0.6762082606821"),
            std::string::npos)
      << got;
}

TEST(Eval, WritesTheErrorOfEveryPose) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "poses.csv").string();
  eval({golden("gt.txt"), golden("est_drift.txt"), "--protocol=evo", "--per-pose=" + file});
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 636u);
  EXPECT_EQ(lines[0].find("reference,estimate,protocol,protocol_version,stamp,x_m,"), 0u);
}

TEST(Eval, ReadsRpgsFolder) {
  const TemporaryFolder folder;
  std::filesystem::copy_file(golden("gt.txt"), folder.path() / "stamped_groundtruth.txt");
  EXPECT_THROW(eval({folder.path().string()}), InputError);
  for (const char* run : {"1", "0"}) {
    std::filesystem::copy_file(
        golden("est_drift.txt"),
        folder.path() / (std::string("stamped_traj_estimate") + run + ".txt"));
  }
  const Json judged = eval_json({folder.path().string(), "--protocol=rpg"});
  ASSERT_EQ(judged.size(), 2u);
  EXPECT_NE(judged[0]["estimate"].get<std::string>().find("estimate0"), std::string::npos);
  EXPECT_NEAR(find(judged[0], "ate", "translation")["rmse"], 0.660473127811482, 1e-12);
}

TEST(Eval, ReadsOvEvalsFolders) {
  const TemporaryFolder folder;
  const auto truths = folder.path() / "truths";
  const auto runs = folder.path() / "algorithms/mine/eight";
  std::filesystem::create_directories(truths);
  std::filesystem::create_directories(runs);
  const std::string algorithms = (folder.path() / "algorithms").string();
  EXPECT_THROW(eval({truths.string(), algorithms}), InputError);
  std::filesystem::copy_file(golden("gt.txt"), truths / "eight.txt");
  std::filesystem::copy_file(golden("est_drift.txt"), runs / "00.txt");
  std::filesystem::copy_file(golden("est_corrected.txt"), runs / "01.txt");
  const Json judged = eval_json({truths.string(), algorithms, "--protocol=ov_eval"});
  ASSERT_EQ(judged.size(), 2u);
  EXPECT_EQ(judged[1]["estimate"], (runs / "01.txt").string());
  EXPECT_EQ(judged[1]["alignment"]["type"], "posyaw");
}

TEST(Eval, RefusesProtocolsThatCannotBe) {
  const std::string tum = golden("gt.txt");
  EXPECT_EQ(refusal<InputError>({tum, tum, "--protocol=evoo"}),
            "no protocol is named 'evoo'; did you mean 'evo'?");
  EXPECT_EQ(refusal<InputError>({tum, tum, "--set=ddof"}),
            "--set: 'ddof' is not FIELD=VALUE, for example ddof=1");
  EXPECT_THROW(eval({tum, tum, "--set=dof=1"}), OptionError);
  EXPECT_THROW(eval({tum, tum, "-r", "fulll"}), OptionError);
  EXPECT_THROW(eval({tum, tum, "-u", "feet"}), OptionError);
  EXPECT_EQ(refusal<OptionError>({tum, tum, "--align=origin", "-s"}),
            "align = origin: has no form with scale; use se3 or none");
  EXPECT_EQ(refusal<OptionError>({tum, tum, "--protocol=evo", "--n_to_align=9"}),
            "align_first = 9: only least squares look at several pairs, not origin or none");
}

TEST(Eval, RefusesWhatItCannotJudge) {
  const std::string kitti = golden("kitti_gt.txt");
  const std::string tum = golden("gt.txt");
  EXPECT_EQ(refusal<InputError>({tum, kitti}).find(kitti + " against " + tum + ": no pose of"), 0u);
  EXPECT_EQ(refusal<OptionError>({tum, tum, "--align=best"}),
            "align = best: expected one of se3 | sim3 | scale | posyaw | origin | posyaw_origin | "
            "none");
  EXPECT_EQ(refusal<OptionError>({tum, tum, "--max-diff=-1"}),
            "max_diff = -1.0 breaks 0 <= max_diff");
  EXPECT_THROW(eval({tum, tum, "--format=rosbag"}), OptionError);
  EXPECT_THROW(eval({tum, tum, "--format=kitti"}), InputError);
  EXPECT_THROW(eval({tum, golden("absent.txt")}), InputError);
  EXPECT_THROW(eval({tum}), CLI::ParseError);

  const TemporaryFolder folder;
  const std::string straight = (folder.path() / "straight.txt").string();
  std::ofstream(straight) << "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n";
  EXPECT_NE(refusal<InputError>({straight, straight}).find("lie on one straight line"),
            std::string::npos);
  EXPECT_NO_THROW(eval({straight, straight, "--align=origin"}));
}

}  // namespace
}  // namespace loopbench
