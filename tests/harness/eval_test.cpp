/// Numbers of `eval` with protocols, options and filters of other tools: evo 1.36 on the same
/// files, smfeval. What `eval` prints is in tests/transcripts.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <tuple>

#include "harness/commands/eval/evaluation_checks.hpp"
#include "tests/support/eval_command.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::test::eval_test {
namespace {

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
  EXPECT_NEAR(rmse({"-d", "1", "-u", "m", "--all_pairs", "--set=pairs_from=reference"}, "rpe"),
              0.0680704819728785,
              1e-12);
  EXPECT_NEAR(rmse({"-d", "10", "-u", "d", "--all_pairs"}, "rpe"), 1.66822987421266, 1e-11);
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
}

TEST(EvalNotes, StateHowPlanesAreAligned) {
  const Pose camera{Rotation(0.5, -0.5, 0.5, -0.5), Vector3::Zero()};  // y down, z forward
  Trajectory up, down;
  for (int i = 0; i <= 100; ++i) {
    const double u = 0.05 * i;
    const Pose pose = turned_about_z(u, 10.0 * Vector3(std::sin(u), -std::cos(u), 0.0));
    up.push_back({u, pose});
    down.push_back({u, normalized(pose * camera)});
  }
  const auto note = [&](const Trajectory& estimate) {
    return plane_text(metrics::evaluate(up, estimate, {.planar = Planar::yes}));
  };
  const std::string moved = "planar, as set: both trajectories were moved to their planes";
  EXPECT_EQ(note(up), moved + " and aligned there");
  EXPECT_EQ(
      note(down),
      moved +
          ", but all six degrees of freedom are aligned, because the axes of their bodies (for "
          "positions, of their world frames) differ");
}

// Several files are evaluated in parallel.
TEST(EvalFiles, ThreadsDoNotMatterForSeveralFiles) {
  const std::vector<std::string> estimates{
      golden("est_drift.txt"), golden("est_corrected.txt"), "absent.txt", golden("est_burst.txt")};
  std::vector<std::string> words{golden("gt.txt"), "--protocol=loopbench,tum"};
  const Json all = eval_json(with(words, estimates), kExitSomeCellsFailed);
  ASSERT_EQ(all.size(), 2 * estimates.size());
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    const Json alone =
        eval_json(with(words, {estimates[i]}), i == 2 ? kExitSomeCellsFailed : kExitOk);
    for (std::size_t k = 0; k < 2; ++k) {
      for (const char* key : {"estimate", "status", "why", "metrics", "pairs"}) {
        EXPECT_EQ(all[2 * i + k].value(key, Json()), alone[k].value(key, Json()))
            << estimates[i] << " " << key;
      }
    }
  }
}

TEST(Eval, ComparesWithTheErrorOfTheReferenceInAnyUnit) {
  for (const auto& [unit, sigma, count] : {std::tuple("mm", "1", "1"), {"km", "0.1", "0"}}) {
    const std::string text =
        eval(with(drift({golden("est_corrected.txt")}), {"--unit", unit, "--ref-sigma", sigma}));
    EXPECT_NE(text.find(std::string("ATE differences: ") + count + " of 1 are below"),
              std::string::npos)
        << text;
  }
}

/// smfeval's definitions of the NEES of positions, recomputed with numpy from its files after a
/// Kabsch alignment: mean, median and coverage of the 90 % region.
TEST(EvalCovariances, OfPositionsAreThoseOfSmfeval) {
  const char* const data = std::getenv("LOOPBENCH_DATA");
  if (data == nullptr) GTEST_SKIP() << "LOOPBENCH_DATA is not set";
  const std::string folder = std::string(data) + "/systems/smfeval/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  struct Expected {
    const char* system;
    double mean, median, coverage;
  };
  for (const Expected& expected :
       {Expected{"real_point_lio", 7.002858291577949, 5.172749260052709, 61.29032258064516},
        Expected{"real_fast_lio2", 265.29502688714524, 207.51889911150724, 0.6451612903225806}}) {
    const Json json = eval_json({folder + "real_fast_lio2/ref.tum",
                                 folder + expected.system + "/est.smfeval",
                                 "--metric",
                                 "nees:gauge=protocol"});
    for (const Json& row : json["metrics"]) {
      if (row["axis"] != "position") continue;
      if (row["relation"] == "nees") {
        EXPECT_NEAR(row["mean"], expected.mean, 1e-9 * expected.mean);
        EXPECT_NEAR(row["median"], expected.median, 1e-9 * expected.median);
      }
      if (row["relation"] == "coverage_90") EXPECT_NEAR(row["mean"], expected.coverage, 1e-9);
    }
  }
}

}  // namespace
}  // namespace loopbench::test::eval_test
