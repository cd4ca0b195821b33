/// `eval` with protocols, options and filters of other tools; evo 1.36 on the same files.
#include <gmock/gmock.h>

#include "tests/support/eval_command.hpp"

namespace loopbench::eval_protocols_test {
namespace {

using namespace test;
using testing::HasSubstr;

double rmse(const std::vector<std::string>& options, const std::string& metric) {
  const Json results = eval_json(with(drift({"--protocol=evo"}), options));
  for (const Json& row : results["metrics"]) {
    if (row["metric"] == metric && row["axis"] == "3d") return row["rmse"];
  }
  ADD_FAILURE() << "no " << metric;
  return 0.0;
}

// Values of golden.json.
TEST(Eval, KnowsEvosHabits) {
  EXPECT_NEAR(rmse({}, "ate"), 12.6565235225568, 1e-10);
  EXPECT_NEAR(rmse({"--align=origin"}, "ate"), 2.12100433850654, 1e-11);
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
  const Json results = eval_json(drift({"--protocol=evo", "--align=origin", "--set=ddof=1"}));
  const Json& protocol = results["protocol"];
  EXPECT_EQ(protocol["name"], "evo");
  EXPECT_EQ(protocol["version"], "26d0953");
  EXPECT_EQ(protocol["changes"], (Json{{"align", "origin"}, {"ddof", 1}}));
  EXPECT_EQ(protocol["rules"]["association"], "evo");
  EXPECT_EQ(results["alignment"]["type"], "origin");
}

TEST(Eval, SeveralProtocolsAndEstimatesAreATable) {
  const std::string got = eval(drift({golden("est_corrected.txt"), "--protocol=tum,rpg"}));
  EXPECT_THAT(got, HasSubstr("tum [evo 26d0953, test/tum_benchmark_tools], rmse against "));
  EXPECT_THAT(got, HasSubstr("rpg [8c8ceec], rmse against "));
  EXPECT_THAT(got, HasSubstr("| ate [m] |"));
  EXPECT_THAT(got, HasSubstr("est_corrected.txt"));
  EXPECT_EQ(eval_json(drift({"--protocol=tum,rpg"})).size(), 2u);
}

TEST(Eval, CsvHoldsALinePerScoreInFull) {
  const std::string got = eval(drift({"--protocol=evo", "-a", "--csv"}));
  EXPECT_THAT(got,
              HasSubstr("golden,0,est_drift,,false,false,evo (align=se3),26d0953,keyframes,ate,ate,"
                        "translation,3d,m,lower,,635,0.6762082606821"));
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
  const Json results = eval_json(drift({"--protocol=tum", "--set=pairs=tum_random"}));
  int rows = 0;
  for (const Json& row : results["metrics"]) rows += row["metric"] == "rpe" ? 1 : 0;
  EXPECT_EQ(rows, 5);
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

TEST(Eval, RefusesAFieldThatIsSetTwice) {
  const auto why = [](const std::vector<std::string>& options) {
    return refusal<InputError>(drift(options));
  };
  EXPECT_EQ(why({"--set=align=sim3", "--align=none"}),
            "align: is set to none by --align and to sim3 by --set");
  EXPECT_EQ(why({"--align=none", "-a"}), "align: is set to none by --align and to se3 by -a");
  EXPECT_EQ(why({"--set=max_diff=1", "--set=max_diff=2"}),
            "max_diff: is set to 1 by --set and to 2 by --set");
  EXPECT_EQ(why({"--t_max_diff=1", "--set=max_diff=1"}),
            "max_diff: is set to 1 by --max-diff and to 1 by --set");
  EXPECT_EQ(why({"--all_pairs", "--set=pairs=tum"}),
            "pairs: is set to tum by --set and to all by --all_pairs");
  EXPECT_EQ(why({"--metric=rpe:delta=1,delta=2"}), "--metric: delta: is set twice in this entry");
}

Json evaluated(const std::vector<std::string>& options) {
  return eval_json(with(drift({"--protocol=evo", "-a"}), options));
}

double ate(const Json& result) { return find(result, "ate", "translation")["rmse"]; }

TEST(EvalFilters, MotionFilterIsThatOfEvo) {
  const Json result = evaluated({"--motion_filter", "0.2", "3"});
  EXPECT_EQ(result["pairs"], 61);  // of 356 poses of the reference
  EXPECT_EQ(result["possible"], 303);
  EXPECT_NEAR(ate(result), 0.6714582585666118, 1e-12);
}

TEST(EvalFilters, TimeRangeCutsTheReference) {
  const Json result = evaluated({"--t_start=1700000010", "--t_end=1700000020"});
  EXPECT_EQ(result["pairs"], 165);
  EXPECT_GT(result["coverage"], 0.95);
  EXPECT_NEAR(ate(result), 0.14221731741268467, 1e-12);
  EXPECT_EQ(refusal<InputError>(drift({"--start=2", "--end=1"})), "--start 2 is after --end 1");
  EXPECT_EQ(refusal<InputError>(drift({"--end=1"})),
            golden("gt.txt") + ": has no poses between --start and --end");
}

TEST(EvalFilters, DownsamplesBothFiles) {
  const Json result = evaluated({"-s", "--downsample=300", "--t_max_diff=0.05"});
  EXPECT_EQ(result["pairs"], 227);
  EXPECT_NEAR(ate(result), 0.6610658733288742, 1e-12);
}

TEST(EvalFilters, PairsAreThoseOfEvo) {
  EXPECT_EQ(evaluated({"--t_max_diff=0.003", "--t_offset=-0.004"})["pairs"], 578);
  // A reference pose can be the nearest one of several poses.
  const Json burst = eval_json({golden("gt.txt"), golden("est_burst.txt"), "--association=evo"});
  EXPECT_EQ(burst["pairs"], 953);
}

TEST(EvalFilters, UnitsChange) {
  EXPECT_NEAR(ate(evaluated({"--change_unit=mm"})), 676.208260682124, 1e-9);
  const Json result = evaluated({"--unit=rad", "-r", "angle_deg"});
  const Json& ape = result["metrics"][0];
  EXPECT_EQ(ape["unit"], "rad");
  EXPECT_NEAR(ape["rmse"], 0.11910329954688206, 1e-12);
  const Json degrees = evaluated({"--unit=deg", "-r", "angle_rad"});
  EXPECT_NEAR(degrees["metrics"][0]["rmse"], 0.11910329954688206 * 180.0 / M_PI, 1e-9);
  EXPECT_THAT(eval(drift({golden("est_corrected.txt"), "--unit=km"})), HasSubstr("| 0.000676 |"));
  EXPECT_EQ(refusal<InputError>(drift({"--unit=inch"})),
            "--unit: found 'inch', expected mm, cm, m, km, deg or rad");
  EXPECT_EQ(refusal<InputError>(drift({"--unit=km", "--metric=coverage"})),
            "--unit km: no score is a length");
}

TEST(EvalFilters, PrintsTheTransformThatTrajReads) {
  const Json alignment = evaluated({"-s"})["alignment"];
  for (const char* key : {"x", "y", "z", "qx", "qy", "qz", "qw", "scale"}) {
    EXPECT_TRUE(alignment[key].is_number()) << key;
  }
  EXPECT_THAT(eval(drift()), HasSubstr("\ntransform  x,y,z,qx,qy,qz,qw = "));
  EXPECT_THAT(eval(drift({"--align=none"})), testing::Not(HasSubstr("\ntransform ")));
}

}  // namespace
}  // namespace loopbench::eval_protocols_test
