// `eval` of several trajectories of one frame, and of runs against each other.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/formats/formats.hpp"
#include "tests/support/eval_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::eval_groups_test {
namespace {

using namespace test;
using testing::HasSubstr;

struct Submaps {
  TemporaryFolder folder;
  std::string first = (folder.path() / "first.txt").string();
  std::string second = (folder.path() / "second.txt").string();

  /// The golden estimate in two files.
  Submaps() {
    const Trajectory all = read_trajectory(golden("est_drift.txt"));
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    write_tum(first, {all.begin(), middle});
    write_tum(second, {middle, all.end()});
  }
};

/// Sum of squared distances over the pairs of all results.
double squares(const Json& results) {
  double out = 0.0;
  for (const Json& result : results) {
    const double rmse = find(result, "ate", "translation")["rmse"];
    out += rmse * rmse * result["pairs"].get<double>();
  }
  return out;
}

TEST(EvalGroups, SubmapsAlignedTogetherHaveTheErrorOfTheCompleteTrajectory) {
  const Submaps maps;
  const std::vector<std::string> files{golden("gt.txt"), maps.first, maps.second};
  const auto with = [&](std::vector<std::string> options) {
    options.insert(options.begin(), files.begin(), files.end());
    return options;
  };
  const Json one = eval_json({golden("gt.txt"), golden("est_drift.txt")});
  const double complete = squares(Json::array({one})), paired = one["pairs"];
  const Json together = eval_json(with({"--align-together"}));
  EXPECT_NEAR(squares(together), complete, 1e-9 * complete);
  EXPECT_LT(squares(eval_json(files)), 0.9 * complete);
  EXPECT_EQ(together[0]["alignment"], together[1]["alignment"]);
  EXPECT_THAT(together[0]["notes"].dump(), HasSubstr("aligned together with"));
  EXPECT_THAT(refusal<InputError>(with({"--align-together", "--align", "none"})),
              HasSubstr("does not align by least squares of all pairs"));
  EXPECT_THAT(eval(with({"--align-together"})),
              testing::AllOf(HasSubstr("over all estimates, aligned together"),
                             HasSubstr(fmt::format(" {:.4g} |", std::sqrt(complete / paired)))));
  EXPECT_THROW(eval(with({"--align-together", "--store", "x"})), CLI::ExcludesError);
  EXPECT_THROW(eval(with({"--align-together", "--pairwise"})), CLI::ExcludesError);
}

TEST(EvalGroups, PartsOfAGroupAreNotIncomplete) {
  TemporaryFolder folder;
  const Trajectory all = read_trajectory(golden("est_drift.txt"));
  std::vector<std::string> files{golden("gt.txt")};
  constexpr std::size_t kParts = 15;
  for (std::size_t k = 0; k < kParts; ++k) {
    files.push_back((folder.path() / fmt::format("submap_{}.txt", k)).string());
    const auto at = [&](std::size_t i) {
      return all.begin() + static_cast<std::ptrdiff_t>(i * all.size() / kParts);
    };
    write_tum(files.back(), {at(k), at(k + 1)});
  }
  files.push_back("--align-together");
  EXPECT_EQ(eval_json(files).size(), kParts);
}

TEST(EvalGroups, RunsAreComparedPairByPair) {
  const std::vector<std::string> runs{
      golden("gt.txt"), golden("est_drift.txt"), golden("est_corrected.txt")};
  const Json all = eval_json({runs[0], runs[1], runs[2], "--pairwise"});
  ASSERT_EQ(all.size(), 3u);
  std::vector<double> expected;
  for (const auto& [i, k] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(k);
    expected.push_back(find(eval_json({runs[a], runs[b]}), "ate", "translation")["rmse"]);
    const Json& pair = all[expected.size() - 1];
    EXPECT_EQ(find(pair, "ate", "translation")["rmse"], expected.back());
  }
  std::ranges::sort(expected);
  const std::string text = eval({runs[0], runs[1], runs[2], "--pairwise"});
  EXPECT_THAT(text, HasSubstr("differences between runs, without a reference"));
  EXPECT_THAT(text, testing::ContainsRegex("ate translation, rmse .m., loopbench +\\| +3 "));
  EXPECT_THAT(text, HasSubstr(fmt::format("{:.4g}", expected[1])));
  EXPECT_THAT(text, testing::Not(HasSubstr("verdict")));
}

/// `laps` rounds of a circle of 10 m at a height, 40 poses each, and five poses more.
Trajectory rounds(int laps, double first_stamp, double height) {
  Trajectory out;
  for (int i = 0; i < 40 * laps + 5; ++i) {
    const double angle = M_PI / 20.0 * i;
    const Vector3 position(10 * std::sin(angle), 10 - 10 * std::cos(angle), height);
    out.push_back({first_stamp + 0.5 * i, {exp_so3({0, 0, angle}), position}});
  }
  return out;
}

}  // namespace
}  // namespace loopbench::eval_groups_test
