// `eval` and `traj` with covariances in files.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/core/covariance.hpp"
#include "datasets/formats/trajectory_file.hpp"
#include "tests/support/eval_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::eval_covariances_test {
namespace {

using namespace test;
using testing::HasSubstr;

/// The golden estimate with a standard deviation of 0.1 m and 0.01 rad.
std::string uncertain(const TemporaryFolder& folder, const char* name) {
  TrajectoryFile file = read_trajectory_file(golden("est_drift.txt"));
  Matrix6 each = Matrix6::Identity();
  each.diagonal() << Vector3::Constant(1e-2), Vector3::Constant(1e-4);
  file.covariances.assign(file.poses.size(), each);
  const auto out = folder.path() / name;
  write_trajectory(out, file, out.extension() == ".csv" ? Format::csv : Format::tum);
  return out.string();
}

double mean_nees(const std::vector<std::string>& arguments, const std::string& axis) {
  return find(eval_json(arguments), "nees", "nees", axis)["mean"];
}

double mean_square(const Json& results, const std::string& relation) {
  const double rmse = find(results, "ate", relation)["rmse"];
  return rmse * rmse;
}

TEST(EvalCovariances, OfEqualAxesScaleTheAte) {
  const TemporaryFolder folder;
  const std::string file = uncertain(folder, "wide.txt");
  const Json full = eval_json(drift({"--metric", "ate"}));
  const std::string metric = "nees:gauge=protocol";
  const std::vector<std::string> arguments{golden("gt.txt"), file, "--metric", metric};
  EXPECT_NEAR(mean_nees(arguments, "position"), mean_square(full, "translation") / 1e-2, 1e-8);
  const double radians = M_PI / 180.0;
  EXPECT_NEAR(mean_nees(arguments, "rotation") * 1e-4,
              mean_square(full, "rotation") * radians * radians,
              1e-8);
  // The stated error of the reference is added to that of the estimate.
  EXPECT_NEAR(
      mean_nees({golden("gt.txt"), file, "--metric", metric, "--ref-sigma", "0.1"}, "position"),
      mean_square(full, "translation") / 2e-2,
      1e-8);
  const Json none = eval_json(drift({"--metric", "ate", "--align", "none"}));
  EXPECT_NEAR(mean_nees({golden("gt.txt"), file, "--metric", "nees:gauge=none"}, "position"),
              mean_square(none, "translation") / 1e-2,
              1e-6);
}

TEST(EvalCovariances, CanBeInAFileOfTheirOwn) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "cov.txt").string();
  std::ofstream out(file);
  for (const StampedPose& pose : read_trajectory(golden("est_drift.txt"))) {
    out << fmt::format("{} 0.01 0 0 0.01 0 0.01\n", pose.stamp);
  }
  out.close();
  const Json full = eval_json(drift({"--metric", "ate"}));
  const std::vector<std::string> arguments{
      golden("gt.txt"), golden("est_drift.txt"), "--metric", "nees", "--cov", file};
  EXPECT_NEAR(mean_nees(arguments, "position"), mean_square(full, "translation") / 1e-2, 1e-8);
  EXPECT_THAT(eval(arguments), HasSubstr("the covariances of the estimate are those of positions"));
  EXPECT_THAT(refusal<InputError>({golden("gt.txt"), "a", "b", "--cov", file}),
              HasSubstr("expected one EST"));
}

TEST(EvalCovariances, AreOptional) {
  EXPECT_THAT(eval(drift({"--metric", "nees", "--metric", "ate"})),
              HasSubstr("the estimate states no covariances"));
}

TEST(EvalCovariances, ConversionsKeepThemOrSayThatTheyAreLost) {
  const TemporaryFolder folder;
  const std::string file = uncertain(folder, "wide.csv");
  const auto out = [&](const char* name) { return (folder.path() / name).string(); };
  for (const char* name : {"a.txt", "a.csv"}) {
    EXPECT_EQ(traj({"convert", file, "-o", out(name)}).errors, "") << name;
    EXPECT_EQ(read_trajectory_file(out(name)).covariances, read_trajectory_file(file).covariances);
  }
  EXPECT_THAT(
      traj({"convert", file, "--to", "euroc", "-o", out("b.csv")}).errors,
      HasSubstr("wide.csv has covariances, which are not written: expected --to csv or tum"));
  EXPECT_THAT(traj({"convert", file, "--project_to_plane", "xy", "-o", out("b.csv")}).errors,
              HasSubstr("wide.csv: covariances are removed"));
  EXPECT_EQ(traj({"transform", file, "--left", "1,2,3", "-o", out("c.csv")}).errors, "");
  EXPECT_EQ(read_trajectory_file(out("c.csv")).covariances.size(), read_trajectory(file).size());
  EXPECT_EQ(traj({"convert", file, "--downsample", "3", "-o", out("d.csv")}).errors, "");
  EXPECT_EQ(read_trajectory_file(out("d.csv")).covariances.size(), 3u);
}

TEST(EvalCovariances, TheConventionIsStatedOrNoted) {
  const TemporaryFolder folder;
  const std::string stated = uncertain(folder, "wide.txt");
  EXPECT_THAT(eval({golden("gt.txt"), stated}), testing::Not(HasSubstr("convention")));
  const std::string bare = (folder.path() / "bare.txt").string();
  std::ifstream in(stated);
  std::string header;
  std::getline(in, header);
  std::ofstream(bare) << in.rdbuf();
  EXPECT_THAT(eval({golden("gt.txt"), bare}),
              HasSubstr("estimate: the convention of the covariances is assumed"));
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
}  // namespace loopbench::eval_covariances_test
