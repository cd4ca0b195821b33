/// eval with other tools' protocols, options and folders.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "harness/eval/evaluation_result.hpp"
#include "tests/support/eval_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::eval_protocols_test {

using namespace metrics;
using namespace harness;

namespace {

using namespace test;

double rmse(const std::vector<std::string>& options, const std::string& metric) {
  std::vector<std::string> arguments{golden("gt.txt"), golden("est_drift.txt"), "--protocol=evo"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Json results = eval_json(arguments);
  for (const Json& row : results["metrics"]) {
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
  EXPECT_NEAR(rmse({"--align", "sim3"}, "ate"), 0.660473127811482, 1e-12);
  EXPECT_NEAR(rmse({"--align"}, "ate"), 0.676208260682124, 1e-12);
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
  const Json results = eval_json({golden("gt.txt"),
                                  golden("est_drift.txt"),
                                  "--protocol=evo",
                                  "--align=origin",
                                  "--set=ddof=1"});
  const Json& protocol = results["protocol"];
  EXPECT_EQ(protocol["name"], "evo");
  EXPECT_EQ(protocol["version"], "26d0953");
  EXPECT_EQ(protocol["changes"], (Json{{"align", "origin"}, {"ddof", 1}}));
  EXPECT_EQ(protocol["rules"]["association"], "evo");
  EXPECT_EQ(results["alignment"]["type"], "origin");
}

TEST(Eval, SeveralProtocolsAndEstimatesAreATable) {
  const std::string got = eval({golden("gt.txt"),
                                golden("est_drift.txt"),
                                golden("est_corrected.txt"),
                                "--protocol=tum,rpg"});
  EXPECT_NE(got.find("tum [evo 26d0953, test/tum_benchmark_tools], rmse against "),
            std::string::npos);
  EXPECT_NE(got.find("rpg [8c8ceec], rmse against "), std::string::npos);
  EXPECT_NE(got.find("| ate [m] |"), std::string::npos);
  EXPECT_NE(got.find("est_corrected.txt"), std::string::npos);
  EXPECT_EQ(eval_json({golden("gt.txt"), golden("est_drift.txt"), "--protocol=tum,rpg"}).size(),
            2u);
}

TEST(Eval, CsvHoldsALinePerScoreInFull) {
  const std::string got =
      eval({golden("gt.txt"), golden("est_drift.txt"), "--protocol=evo", "-a", "--csv"});
  EXPECT_NE(got.find("golden,0,est_drift,,false,false,evo (align=se3),26d0953,keyframes,ate,ate,"
                     "translation,3d,m,lower,,635,0.6762082606821"),
            std::string::npos)
      << got;
}

TEST(Eval, EvaluatesKittiByTheDigitsOfItsFiles) {
  const Json results =
      eval_json({golden("kitti_gt.txt"), golden("kitti_est.txt"), "--protocol=kitti-double"});
  double mean = 0.0;
  for (const Json& row : results["metrics"]) {
    if (row["relation"] == "rotation" && row["axis"] == "all") mean = row["mean"];
  }
  EXPECT_NEAR(mean, 0.0128037720163, 1e-9 * 0.0128);
}

TEST(Eval, DrawsTumsRandomPairsOnce) {
  const Json results = eval_json(
      {golden("gt.txt"), golden("est_drift.txt"), "--protocol=tum", "--set=pairs=tum_random"});
  EXPECT_NEAR(find(results, "rpe", "translation")["rmse"], 1.5566026278354204, 1e-9);
  int rows = 0;
  for (const Json& row : results["metrics"]) rows += row["metric"] == "rpe" ? 1 : 0;
  EXPECT_EQ(rows, 5);
}

TEST(Eval, BelowTheLimitOfCoverageIsIncomplete) {
  const std::vector<std::string> arguments{
      golden("gt.txt"), golden("est_drift.txt"), "--min-coverage=0.97"};
  const std::string why =
      "evaluated 635 of 657 poses over 100.0 % of the reference's time, below 97.0 %";
  const Json results = eval_json(arguments, kExitSomeCellsFailed);
  EXPECT_EQ(results["status"], "incomplete");
  EXPECT_EQ(results["why"], why);
  EXPECT_GT(find(results, "ate", "translation")["rmse"], 0.0);  // reported nevertheless
  EXPECT_NE(eval(arguments, kExitSomeCellsFailed).find("\nincomplete " + why + "\n"),
            std::string::npos);
  const Json enough = eval_json({arguments[0], arguments[1], "--min-coverage=0.96"});
  EXPECT_EQ(enough["status"], "ok");
  const std::string table =
      eval({arguments[0], arguments[1], golden("est_corrected.txt"), "--min-coverage=0.97"},
           kExitSomeCellsFailed);
  EXPECT_NE(table.find("est_corrected.txt: incomplete: " + why), std::string::npos) << table;
  EXPECT_NE(table.find(" incomplete |"), std::string::npos) << table;
  EXPECT_THROW(eval({arguments[0], arguments[1], "--min-coverage=1.5"}), CLI::ParseError);
}

TEST(Eval, RefusesProtocolsThatCannotBe) {
  const std::string tum = golden("gt.txt");
  EXPECT_EQ(refusal<InputError>({tum, tum, "--protocol=evoo"}),
            "no protocol is named 'evoo'; did you mean 'evo'?");
  EXPECT_EQ(refusal<InputError>({tum, tum, "--protocol=evo,tum,evo"}),
            "--protocol: 'evo' is listed twice");
  EXPECT_EQ(refusal<InputError>({tum, tum, "--set=ddof"}),
            "--set: found 'ddof', expected OPTION=VALUE");
  EXPECT_EQ(refusal<OptionError>({tum, tum, "--align=origin", "-s"}),
            "align = origin: has no variant with scale; use se3 or none");
}

}  // namespace
}  // namespace loopbench::eval_protocols_test
