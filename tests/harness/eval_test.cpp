#include <gmock/gmock.h>

#include <iterator>
#include <sstream>

#include "tests/support/eval_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::eval_test {
namespace {

using namespace test;
using testing::HasSubstr;
using testing::StartsWith;

// Values of golden.json, evo APE translation_part at max_diff 0.01.
TEST(Eval, EqualsEvoUnderEvosAssociation) {
  const Json sim3 = eval_json(drift({"--association=evo", "--max-diff=0.01", "--align=sim3"}));
  EXPECT_EQ(sim3["pairs"], 635);
  EXPECT_EQ(sim3["alignment"]["type"], "sim3");
  EXPECT_NEAR(sim3["alignment"]["scale"], 0.9848728953975282, 1e-12);
  EXPECT_NEAR(find(sim3, "ate", "translation")["rmse"], 0.660473127811482, 1e-12);
}

std::vector<std::string> words(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

TEST(Eval, JsonHasThePromisedKeysAndTheDiagnosis) {
  const Json results = eval_json({golden("gt.txt"), golden("est_corrected.txt")});
  const std::string keys =
      "reference estimate protocol pairs possible coverage span alignment diagnosis notes metrics "
      "undefined failed";
  for (const std::string& key : words(keys)) EXPECT_TRUE(results.contains(key)) << key;
  EXPECT_EQ(results["coverage"].get<double>(),
            results["pairs"].get<double>() / results["possible"].get<double>());
  std::map<std::string, int> rows;
  for (const Json& row : results["metrics"]) {
    ++rows[row["metric"]];
    for (const std::string& key :
         words("metric relation axis unit rmse mean median std min max count")) {
      EXPECT_TRUE(row.contains(key)) << key;
    }
  }
  // rpe: 1 frame, 1 s, 1 m; five rows each. segments: all lengths together.
  EXPECT_EQ(
      rows,
      (std::map<std::string, int>{{"ate", 2}, {"axis_error", 3}, {"rpe", 15}, {"segments", 2}}));
  EXPECT_EQ(results["diagnosis"]["matched"], 635.0);
  EXPECT_EQ(results["diagnosis"]["position_only_reference"], 0.0);
  EXPECT_THAT(eval({golden("gt.txt"), golden("est_corrected.txt"), "--full"}),
              HasSubstr("\ndiagnosis  matched 635, possible 657, longest_pair_interval 1.86 s, "
                        "repeated 0, "));
}

TEST(Eval, RefusesRotationOfPositionsAlone) {
  const TemporaryFolder folder;
  std::ostringstream rows;
  for (int i = 0; i < 20; ++i) rows << i << " " << i << " " << i * i << " 0 0 0 0 1\n";
  const std::string file = folder.file("positions.txt", rows.str()).string();
  const Json results = eval_json({file, file});
  EXPECT_EQ(find(results, "ate", "translation")["count"], 20);
  EXPECT_EQ(results["undefined"][0]["metric"], "ate");
  EXPECT_EQ(results["undefined"][0]["relation"], "rotation");
  const std::string text = eval({file, file});
  EXPECT_THAT(text, HasSubstr("\nate [deg], rpe 1 s [m], rpe 1 s [deg] undefined: "));
  EXPECT_THAT(text, HasSubstr(" undefined: the reference has a constant"));
  EXPECT_EQ(text.find("the reference has a constant"), text.rfind("the reference has a constant"));
}

TEST(Eval, TimesBelongToWhicheverFileIsKitti) {
  const TemporaryFolder folder;
  std::ostringstream rows;
  for (int i = 0; i < 1200; ++i) rows << 1000.0 + 0.5 * i << "\n";
  const std::string times = folder.file("times.txt", rows.str()).string();
  const std::vector<std::string> kitti{golden("kitti_gt.txt"), golden("kitti_est.txt")};
  const Json numbered = eval_json(kitti);  // pairs by number
  EXPECT_EQ(numbered["pairs"], 1200);
  EXPECT_EQ(numbered["coverage"], 1.0);
  const Json results = eval_json(with(kitti, {"--times=" + times}));
  EXPECT_EQ(results["pairs"], 1200);
  for (const Json& row : results["metrics"]) {
    // 0.5 s apart, so 1 s is two poses on.
    if (row["label"] == "rpe 1 s") {
      EXPECT_EQ(row["count"], 1198);
    }
  }
  EXPECT_EQ(refusal<InputError>(drift({"--times=" + times})),
            times + ": is a times file, but no file has KITTI poses");
  EXPECT_EQ(refusal<InputError>(drift({"--period=3"})),
            "--period 3.0: all files have stamps, expected KITTI poses without --times, or g2o");
}

TEST(Eval, AcceptsEveryMetric) {
  const Json all = eval_json(
      drift({"--metric=path_length", "--metric=rpe:delta=2,unit=s", "--metric=closure_residual"}));
  EXPECT_EQ(all["metrics"][0]["metric"], "path_length");
  EXPECT_EQ(find(all, "rpe", "translation")["label"], "rpe 2 s");
  EXPECT_EQ(find(all, "rpe", "translation")["rmse"],
            find(eval_json(drift({"-d", "2", "-u", "s"})), "rpe", "translation")["rmse"]);
  ASSERT_EQ(all["undefined"].size(), 1u);  // files have no loop closures
  EXPECT_EQ(all["undefined"][0]["metric"], "closure_residual");
  for (const MetricEntry& entry : metrics::metrics()) {
    EXPECT_TRUE(eval_json(drift({"--metric=ate", "--metric=" + entry.name}))["failed"].empty())
        << entry.name;
  }
  EXPECT_EQ(refusal<InputError>(drift({"--metric=path_lenght"})),
            "--metric: no metric is named 'path_lenght'; did you mean 'path_length'?");
  EXPECT_THAT(refusal<InputError>(drift({"--metric=rpe:delt=2"})), HasSubstr("delta"));
  EXPECT_THROW(eval(drift({"--metric=ate", "-r", "full"})), CLI::ParseError);
}

TEST(Eval, TakesFiniteNumbersOnly) {
  for (const std::string& option : words("--min-coverage=nan --t_max_diff=inf --max-gap=inf "
                                         "--t_offset=nan --delta=nan --period=inf")) {
    EXPECT_THROW(eval(drift({option})), CLI::ValidationError) << option;
  }
  EXPECT_EQ(refusal<InputError>(drift({"--set=max_diff=inf"})),
            "--set: max_diff=inf: expected a finite number");
}

TEST(Eval, NamesNeedNotBeUtf8) {
  const TemporaryFolder folder;
  const std::string line = "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 0 1 0 0 0 0 1\n";
  const std::string file = folder.file("a\xff.txt", line).string();
  EXPECT_EQ(eval_json({file, file})["estimate"],
            (folder.path() / "a\xef\xbf\xbd.txt").string());  // U+FFFD
}

TEST(Eval, WritesOverNoneOfItsInputs) {
  const TemporaryFolder folder;
  std::filesystem::copy_file(golden("est_drift.txt"), folder.path() / "mine.txt");
  std::filesystem::create_symlink("mine.txt", folder.path() / "link");
  const std::string mine = (folder.path() / "mine.txt").string();
  const std::string link = (folder.path() / "." / "link").string();
  EXPECT_EQ(refusal<InputError>({golden("gt.txt"), mine, "--per-pose=" + link}),
            link + ": is an input of this command and is not overwritten");
  EXPECT_THROW(eval({golden("gt.txt"), link, "--per-pose=" + mine}), InputError);
  EXPECT_THROW(eval({mine, golden("gt.txt"), "--per-pose=" + mine}), InputError);
  EXPECT_EQ(std::filesystem::file_size(mine), std::filesystem::file_size(golden("est_drift.txt")));
}

TEST(Eval, RefusesWhatItCannotEvaluate) {
  const std::string kitti = golden("kitti_gt.txt");
  const std::string tum = golden("gt.txt");
  EXPECT_THAT(refusal<InputError>({tum, kitti, "--period=0.1"}),
              StartsWith(kitti + " with reference " + tum + ": no pose of"));
  EXPECT_EQ(refusal<OptionError>({tum, tum, "--max-diff=-1"}),
            "max_diff = -1.0: expected 0 <= max_diff");
  EXPECT_THROW(eval({tum, tum, "--format=kitti"}), InputError);
  EXPECT_THROW(eval({tum, golden("absent.txt")}), InputError);
  EXPECT_THROW(eval({tum}), CLI::ParseError);

  const TemporaryFolder folder;
  const std::string line = "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n";
  const std::string straight = folder.file("straight.txt", line).string();
  EXPECT_THAT(refusal<InputError>({straight, straight}), HasSubstr("lie on one straight line"));
  EXPECT_NO_THROW(eval({straight, straight, "--align=origin"}));
}

}  // namespace
}  // namespace loopbench::eval_test
