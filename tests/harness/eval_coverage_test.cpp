// Coverage of a trajectory in `eval`, and messages about low coverage.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/eval_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::eval_coverage_test {
namespace {

using namespace test;
using testing::HasSubstr;
using testing::Not;

/// A spiral at `speed`, poses every `step` from `begin` to `end`, with a sinusoidal error.
std::string spiral(double begin, double end, double step, double speed, double error) {
  std::string out;
  for (int i = 0; begin + i * step <= end; ++i) {
    const double t = begin + i * step;
    const double radius = 20.0 + 0.1 * t;
    const double angle = speed * t / 20.0;
    out += std::to_string(t) + " " + std::to_string(radius * std::cos(angle)) + " " +
           std::to_string(radius * std::sin(angle)) + " " +
           std::to_string(error * std::sin(7.0 * t)) + " 0 0 " +
           std::to_string(std::sin(0.5 * angle)) + " " + std::to_string(std::cos(0.5 * angle)) +
           "\n";
  }
  return out;
}

class EvalCoverage : public testing::Test {
 protected:
  std::string written(const std::string& name, const std::string& text) const {
    return folder_.file(name, text).string();
  }

  TemporaryFolder folder_;
  std::string reference_ = written("reference.txt", spiral(0.0, 100.0, 0.1, 1.0, 0.0));
  std::string complete_ = written("complete.txt", spiral(0.0, 100.0, 0.1, 1.0, 0.3));
  std::string short_ = written("short.txt", spiral(40.0, 40.45, 0.1, 1.0, 0.01));
};

TEST_F(EvalCoverage, FivePosesOfAThousandAreIncompleteBesideOthers) {
  const std::vector<std::string> both{reference_, complete_, short_};
  const Json results = eval_json(both, kExitSomeCellsFailed);
  EXPECT_EQ(results[0]["status"], "ok");
  EXPECT_EQ(results[1]["status"], "incomplete");
  EXPECT_EQ(results[1]["coverage"], 1.0);  // all of its own five poses
  EXPECT_LT(results[1]["span"], 0.01);
  EXPECT_EQ(
      results[1]["why"],
      "evaluated 5 of 5 poses over 0.4 % of the reference's time, less than half of the 100.0 "
      "% of another estimate (--min-coverage 0 accepts it)");
  const std::string table = eval(both, kExitSomeCellsFailed);
  EXPECT_THAT(table, HasSubstr("| coverage [%] |"));
  EXPECT_THAT(table, HasSubstr("\n- short.txt: incomplete: evaluated 5 of 5 poses over 0.4 %"));
  EXPECT_EQ(eval_json(with(both, {"--min-coverage=0"}))[1]["status"], "ok");
  // The RPE shows its own number of pairs.
  EXPECT_THAT(eval(with(both, {"--min-coverage=0"})), HasSubstr("rpe 1 s [m]: 992;"));
}

TEST_F(EvalCoverage, ATenthIsTheLeastForOneEstimate) {
  EXPECT_EQ(eval_json({reference_, short_}, kExitSomeCellsFailed)["why"],
            "evaluated 5 of 5 poses over 0.4 % of the reference's time, less than a tenth "
            "(--min-coverage 0 accepts it)");
  EXPECT_EQ(eval_json({reference_, short_, "--min-coverage=0"})["status"], "ok");
  EXPECT_EQ(eval_json({reference_, short_, "--start=40", "--end=41"})["status"], "ok");
  const std::string tenth = written("tenth.txt", spiral(40.0, 51.0, 0.1, 1.0, 0.3));
  EXPECT_EQ(eval_json({reference_, tenth})["status"], "ok");
}

TEST_F(EvalCoverage, BelowTheStatedLimitIsIncomplete) {
  const std::vector<std::string> limited = drift({"--min-coverage=0.97"});
  const std::string why =
      "evaluated 635 of 657 poses over 100.0 % of the reference's time, below 97.0 %";
  const Json results = eval_json(limited, kExitSomeCellsFailed);
  EXPECT_EQ(results["status"], "incomplete");
  EXPECT_EQ(results["why"], why);
  EXPECT_GT(find(results, "ate", "translation")["rmse"], 0.0);  // reported nevertheless
  EXPECT_THAT(eval(limited, kExitSomeCellsFailed), HasSubstr("\nincomplete " + why + "\n"));
  EXPECT_EQ(eval_json(drift({"--min-coverage=0.96"}))["status"], "ok");
  const std::string table =
      eval(with(limited, {golden("est_corrected.txt")}), kExitSomeCellsFailed);
  EXPECT_THAT(table, HasSubstr("est_corrected.txt: incomplete: " + why));
  EXPECT_THAT(table, HasSubstr(" incomplete |"));
  EXPECT_THROW(eval(drift({"--min-coverage=1.5"})), CLI::ParseError);
}

TEST_F(EvalCoverage, FewPosesDoNotCoverTheTimeBetweenThem) {
  const std::string sparse = written("sparse.txt", spiral(0.0, 100.0, 20.0, 1.0, 0.3));
  EXPECT_THAT(eval({reference_, sparse}), HasSubstr("6 of 6 (100.0 %), over 25.0 % of the"));
  // Nor do those of a reference that has no more of them.
  EXPECT_THAT(eval({sparse, complete_}), HasSubstr("6 of 1001 (0.6 %), over 100.0 % of the"));
}

TEST_F(EvalCoverage, FewPairsOfOneEstimateAreIncomplete) {
  // Stamps 0.05 s beside those of the reference, but for every 20th.
  std::string text;
  std::istringstream poses(spiral(0.0, 100.0, 0.1, 1.0, 0.3));
  int i = 0;
  for (std::string line; std::getline(poses, line); ++i) {
    const std::size_t space = line.find(' ');
    const double stamp = std::stod(line) + (i % 20 == 0 ? 0.0 : 0.05);
    text += std::to_string(stamp) + line.substr(space) + "\n";
  }
  const std::string few = written("few_pairs.txt", text);
  EXPECT_EQ(eval_json({reference_, few}, kExitSomeCellsFailed)["why"],
            "evaluated 51 of 1001 poses over 100.0 % of the reference's time, less than a tenth "
            "(--min-coverage 0 accepts it)");
  EXPECT_EQ(eval_json({reference_, few, "--min-coverage=0"})["status"], "ok");
}

TEST_F(EvalCoverage, CommonTimesOfAllEstimatesAreCompared) {
  const std::string half = written("half.txt", spiral(0.0, 60.0, 0.1, 1.0, 0.3));
  const std::string late = written("late.txt", spiral(20.0, 100.0, 0.1, 1.0, 0.3));
  const auto count = [](const Json& result) {
    return find(result, "ate", "translation")["count"].get<int>();
  };
  const std::vector<std::string> files{reference_, complete_, half, late};
  EXPECT_EQ(count(eval_json(files)[1]), 601);
  const Json results = eval_json(with(files, {"--common=yes"}));
  for (const Json& result : results) EXPECT_NEAR(count(result), 401, 1) << result;
  EXPECT_NEAR(results[1]["span"].get<double>(), 0.6, 0.01);  // the loss stays visible
  const auto stored = with(files, {"--store", (folder_.path() / "store").string()});
  const std::string out = eval(stored);
  EXPECT_THAT(out, HasSubstr("% of the reference, others up to 100 %"));
  EXPECT_THAT(out, Not(HasSubstr(" is best: ")));
  eval(with(stored, {"--common=no"}));
}

TEST_F(EvalCoverage, FewPairsAfterAFitAreNoted) {
  const std::string few = written("few.txt", spiral(10.0, 10.35, 0.1, 5.0, 0.1));
  EXPECT_THAT(eval({reference_, few, "--min-coverage=0"}),
              HasSubstr("note       few pairs: 4 pairs have 12 coordinates, and alignment se3 fits "
                        "6 parameters to them, so the errors are about 29 % too small"));
  EXPECT_THAT(eval({reference_, few, "--align=none", "--min-coverage=0"}),
              Not(HasSubstr("few pairs")));
  EXPECT_THAT(eval({reference_, complete_}), Not(HasSubstr("few pairs")));
}

TEST_F(EvalCoverage, AssociationThatCostsAccuracyIsNoted) {
  const std::string fast = written("fast.txt", spiral(0.0, 100.0, 0.04, 15.0, 0.0));
  const std::string perfect = written("perfect.txt", spiral(0.013, 100.0, 0.1, 15.0, 0.0));
  const std::string text = eval({fast, perfect});
  EXPECT_THAT(text,
              HasSubstr("note       association: the stamps of paired poses differ by up to 0.0"));
  EXPECT_THAT(text, HasSubstr("use association interpolate"));
  EXPECT_THAT(eval({fast, perfect, "--association=interpolate"}), Not(HasSubstr("note ")));
  EXPECT_EQ(eval_json({fast, perfect})["notes"].size(), 1u);
  EXPECT_EQ(eval_json({reference_, complete_})["notes"].dump(), "[]");
}

}  // namespace
}  // namespace loopbench::eval_coverage_test
