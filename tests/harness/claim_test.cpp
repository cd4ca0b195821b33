/// Claims: answers worked by hand, the correction for repeated looks, and the file.
#include "harness/compare/claim.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "harness/config/read_claim.hpp"
#include "harness/tables/claim_store.hpp"
#include "tests/support/command.hpp"
#include "tests/support/compared_sweep.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::claim_test {

using namespace harness;

namespace {

/// dual is 10 to 17 % below uniform on each of eight runs.
Look look_of(double margin, const std::string& method = "dual") {
  using namespace compared_sweep;  // NOLINT: its records
  CompareOptions options;
  options.baseline = "uniform";
  options.alpha = level_of_look(0.05, 1);
  std::vector<Record> records = sweep();
  std::erase_if(records,
                [&](const Record& r) { return r.method != method && r.method != "uniform"; });
  Claim claim;
  claim.method = method;
  claim.baseline = "uniform";
  claim.margin = margin;
  return look_at(claim, compare(records, options).at(0), options.alpha);
}

TEST(Claim, IsAnsweredByTheIntervalOfTheRatio) {
  const Look look = look_of(0.05);
  EXPECT_EQ(look.answer, ClaimAnswer::holds);  // all ratios lie below 0.95
  EXPECT_GE(look.low, 0.83);
  EXPECT_LE(look.high, 0.90);
  EXPECT_NEAR(look.ratio, 0.865, 1e-3);
  EXPECT_EQ(look.wins, 8u);
  EXPECT_EQ(look_of(0.135).answer, ClaimAnswer::cannot_tell);
  EXPECT_EQ(look_of(0.2).answer, ClaimAnswer::does_not_hold);  // all lie above 0.80
  EXPECT_EQ(look_of(0.0, "raw").answer, ClaimAnswer::does_not_hold);
  EXPECT_EQ(look_of(-1.5, "raw").answer, ClaimAnswer::holds);  // at most 150 % above
}

TEST(Claim, CannotBeToldFromFewRuns) {
  using namespace compared_sweep;  // NOLINT: its records
  std::vector<Record> records;
  for (int i = 0; i < 5; ++i) {
    records.push_back(score("room", i, "dual", 0.1));
    records.push_back(score("room", i, "uniform", 1.0 + 0.1 * i));
  }
  CompareOptions options;
  options.baseline = "uniform";
  options.alpha = level_of_look(0.05, 1);
  Claim claim;
  claim.method = "dual";
  claim.baseline = "uniform";
  const Look look = look_at(claim, compare(records, options).at(0), options.alpha);
  EXPECT_EQ(look.answer, ClaimAnswer::cannot_tell);
  EXPECT_TRUE(std::isinf(look.high));
  EXPECT_NE(text_of(claim, look).find("too few groups"), std::string::npos);
}

TEST(Claim, SpendsAlphaOverAllLooks) {
  EXPECT_DOUBLE_EQ(level_of_look(0.05, 1), 0.05 * 2 / 3);
  EXPECT_DOUBLE_EQ(level_of_look(0.05, 2), 0.05 / 6);
  EXPECT_DOUBLE_EQ(level_of_look(0.05, 3), 0.05 / 18);
  double sum = 0.0;
  for (std::size_t k = 1; k <= 10'000; ++k) sum += level_of_look(0.05, k);
  EXPECT_LT(sum, 0.05);
  EXPECT_GT(sum, 0.0499);
}

/// New data of equal methods at each of five looks: any answer but "cannot tell" is false.
TEST(Claim, IsFalselyAnsweredInAtMostAlphaOfAllSeriesOfLooks) {
  using namespace compared_sweep;  // NOLINT: its records
  std::mt19937_64 bits(7);
  std::normal_distribution<double> normal;
  constexpr int kSeries = 300;
  int wrong = 0;
  for (int series = 0; series < kSeries; ++series) {
    bool is_wrong = false;
    for (std::size_t k = 1; k <= 5; ++k) {
      std::vector<Record> records;
      for (int i = 0; i < 12; ++i) {
        records.push_back(score("s" + std::to_string(i), 0, "dual", std::exp(normal(bits))));
        records.push_back(score("s" + std::to_string(i), 0, "uniform", std::exp(normal(bits))));
      }
      CompareOptions options;
      options.baseline = "uniform";
      options.alpha = level_of_look(0.05, k);
      Claim claim;
      claim.method = "dual";
      claim.baseline = "uniform";
      const Look look = look_at(claim, compare(records, options).at(0), options.alpha);
      is_wrong = is_wrong || look.answer != ClaimAnswer::cannot_tell;
    }
    wrong += is_wrong ? 1 : 0;
  }
  EXPECT_LE(wrong, 0.05 * kSeries + 3 * std::sqrt(0.05 * 0.95 * kSeries));
  EXPECT_GT(wrong, 0);
}

const char* const kClaim =
    "# kept\n"
    "statement: dual is better\n"
    "config: quick.yaml\n"
    "method: dual\n"
    "baseline: raw\n"
    "margin: 0.05\n"
    "sequences: {room: 'beef'}\n";

TEST(ClaimFile, ReadsBackWhatItWrites) {
  Claim claim = parse_claim(kClaim, "c.yaml");
  claim.where = {"times=dense", "label='it''s'"};
  claim.looks = {
      {"2026-11-25", "abc", 0.0333333, ClaimAnswer::does_not_hold, 1.5, 1.25, 2, 1.5, 3, 9},
      {"2026-11-26",
       "def",
       0.008,
       ClaimAnswer::cannot_tell,
       1.0,
       0.0,
       std::numeric_limits<double>::infinity(),
       std::nan(""),
       0,
       0}};
  const Claim again = parse_claim(yaml(claim), "c.yaml");
  EXPECT_EQ(yaml(again), yaml(claim));
  EXPECT_EQ(again.where, claim.where);
  EXPECT_EQ(again.sequences.at("room"), "beef");
  EXPECT_EQ(again.looks.at(0).answer, ClaimAnswer::does_not_hold);
  EXPECT_TRUE(has_same_results(again.looks[0], claim.looks[0]));
  EXPECT_TRUE(has_same_results(again.looks[1], claim.looks[1]));
  EXPECT_FALSE(has_same_results(again.looks[0], again.looks[1]));
}

TEST(ClaimFile, KeepsItsTextWhenALookIsAdded) {
  const Look look{"2026-11-25", "abc", 0.03, ClaimAnswer::holds, 0.5, 0.4, 0.6, 0.5, 8, 0};
  const std::string one = with_look(kClaim, "c.yaml", look);
  EXPECT_TRUE(one.starts_with(kClaim));
  const std::string two = with_look(one, "c.yaml", look);
  EXPECT_EQ(parse_claim(two, "c.yaml").looks.size(), 2u);
  EXPECT_NE(refusal_of([&] { with_look(one + "value: max\n", "c.yaml", look); }).find("last key"),
            std::string::npos);
}

TEST(ClaimFile, NamesWhatIsWrong) {
  const auto why = [](const std::string& text) {
    return refusal_of([&] { parse_claim(text, "c.yaml"); });
  };
  EXPECT_EQ(why("config: a\nmethod: b\n"), "c.yaml:1: 'baseline' is missing");
  EXPECT_NE(why(std::string(kClaim) + "margn: 1\n")
                .find("c.yaml:8: no setting is named 'margn'; did you mean 'margin'?"),
            std::string::npos);
  EXPECT_NE(why(std::string(kClaim) + "expected: maybe\n").find("holds"), std::string::npos);
}

const char* const kConfig =
    "datasets: [{dataset: simulated, path: driving, keyframes: 60, label: road}]\n"
    "methods: [raw, uniform, dual]\n"
    "metrics: [ate]\n"
    "times: keyframes\n"
    "repeats: 8\n";

TEST(ClaimCommand, ANewOptionOfADatasetIsNoOtherRun) {
  EXPECT_EQ(definition_of_run("simulated: path=room",
                              "simulated: new=0, path=room, seed=7, stream=; a.txt 3 beef"),
            "simulated: path=room, seed=7; a.txt 3 beef");
  EXPECT_EQ(definition_of_run("line: n=4", "line: bias=0, n=4, seed=3"), "line: n=4, seed=3");
  EXPECT_EQ(definition_of_run("file: a=1", "file: a=1, b=2; a.txt 3 beef"),
            "file: a=1; a.txt 3 beef");
}

TEST(ClaimCommand, WritesRunsAndRecordsALookOnce) {
  TemporaryFolder folder;
  const auto run = [&](const std::string& words) { return loopbench_command(words, folder); };
  folder.file("c.yaml", kConfig);
  ASSERT_EQ(run("run c.yaml --out r").exit_code, 0);
  const CommandResult wrote =
      run("compare r --where unit=m --baseline raw --as-claim claims/a.yaml --config c.yaml");
  ASSERT_EQ(wrote.exit_code, 0) << wrote.err;
  const std::string text = read_all(folder.path() / "claims/a.yaml");
  EXPECT_NE(text.find("config: '../c.yaml'"), std::string::npos) << text;
  EXPECT_EQ(parse_claim(text, "a.yaml").sequences.size(), 1u);
  // The same results, in a new store with only the two methods.
  const CommandResult again = run("claim claims/a.yaml --out again");
  EXPECT_EQ(again.exit_code, 0) << again.err << again.out;
  EXPECT_TRUE(again.out.starts_with("holds: ")) << again.out;
  EXPECT_NE(again.out.find("no look is spent"), std::string::npos) << again.out;
  EXPECT_EQ(read_all(folder.path() / "claims/a.yaml"), text);
  // Another claim about the same runs is a new look; its answer is not the expected one.
  std::string strict = text.substr(0, text.find("looks:"));
  strict.replace(strict.find("margin: 0"), 9, "margin: 0.98");
  folder.file("claims/strict.yaml", strict);
  const CommandResult other = run("claim claims/strict.yaml --out again");
  EXPECT_EQ(other.exit_code, 1) << other.err << other.out;
  EXPECT_NE(other.out.find("\n  expected: holds\n"), std::string::npos) << other.out;
  EXPECT_EQ(parse_claim(read_all(folder.path() / "claims/strict.yaml"), "").looks.size(), 1u);
  // The margin was edited after the look: its interval gives another answer, and no look is spent.
  std::string edited = read_all(folder.path() / "claims/strict.yaml");
  edited.replace(edited.find("margin: 0.98"), 12, "margin: 0.00");
  folder.file("claims/strict.yaml", edited);
  const CommandResult looser = run("claim claims/strict.yaml --out again");
  EXPECT_TRUE(looser.out.starts_with("holds: ")) << looser.out;
  EXPECT_NE(looser.out.find("no look is spent"), std::string::npos) << looser.out;
  // Other data are another claim.
  std::string changed = kConfig;
  changed.replace(changed.find("60"), 2, "61");
  folder.file("c.yaml", changed);
  const CommandResult refused = run("claim claims/a.yaml --out changed");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("has other runs, options or files"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace loopbench::claim_test
