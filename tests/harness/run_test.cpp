/// A complete sweep on the tiny catalogue: cells, store, threads, resilience.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "harness/sweep/catalogue/load_sequence.hpp"
#include "harness/sweep/config/read_sweep.hpp"
#include "harness/sweep/store/store.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/tiny_catalogue.hpp"

namespace loopbench::tiny::run_test {
namespace {

const char* const kConfig = R"(
datasets:
  - {dataset: line, sweep: {bias: [0.1, 0.2, 0.3]}}
methods:
  - straight
  - {method: shift + straight, label: shifted}
  - {method: shift, fail: true, label: fails}
  - {method: shift, decline: true, label: declines}
metrics: [ate, {metric: ate, power: 2, label: undefined}]
times: keyframes
baseline: straight
repeats: 3
)";

class RunSweep : public testing::Test {
 protected:
  std::vector<Record> run() {
    const std::filesystem::path file = folder_.path() / "out" / "results.sqlite";
    const std::vector<Cell> planned = cells(sweep_, seeded(sweep_, known_), "");
    CellKeys keys(sweep_, known_, {}, "build");
    {
      Store store(file, keys, {}, true);
      run_here(sweep_, planned, known_, {}, [&](const CellResult& result) { store.write(result); });
    }
    return read_records(file);
  }

  TemporaryFolder folder_;
  Catalogue known_ = catalogue();
  Sweep sweep_ = parse_sweep(kConfig, "c.yaml", known_);
};

TEST_F(RunSweep, EveryCellLeavesItsRow) {
  const std::vector<Record> records = run();
  // 3 datasets x 3 repeats x (2 methods x 2 metrics + failed + declined)
  EXPECT_EQ(records.size(), 3u * 3u * 6u);
  const auto count = [&](Status status) {
    return std::ranges::count(records, status, &Record::status);
  };
  EXPECT_EQ(count(Status::ok), 18);
  EXPECT_EQ(count(Status::failed), 9 + 18);  // the method, and the undefined metric of the others
  EXPECT_EQ(count(Status::declined), 9);
  const auto fails =
      std::ranges::find(records, "fails", [](const Record& r) { return r.cell->method.text(); });
  EXPECT_EQ(fails->why, "set to fail");
  const auto undefined =
      std::ranges::find(records, "undefined", [](const Record& r) { return r.kind->label; });
  EXPECT_EQ(undefined->why, "set to be undefined");
}

/// The reference lasts 9 s, the keyframes end after 3 s: coverage is a third at either times.
TEST_F(RunSweep, TooLittleCoverageIsIncompleteAndIsNotAveraged) {
  known_.datasets[0].load = [](const Params& given, const DataRoot& root) {
    Sequence out = load_line(with(LineOptions{}, given), root);
    if (given.at("bias") == Param(0.3)) out.reference.push_back({9.0, {}});
    return out;
  };
  sweep_.min_coverage = 0.5;
  const std::vector<Record> records = run();
  int incomplete = 0;
  for (const Record& r : records) {
    const bool is_short = r.cell->sequence.text().find("0.3") != std::string::npos;
    if (r.cell->method != "straight" || r.kind->label != "ate") continue;
    EXPECT_EQ(r.status, is_short ? Status::incomplete : Status::ok) << r.cell->sequence;
    EXPECT_GT(r.statistics.rmse, 0.0);  // stored nevertheless
    if (!is_short) continue;
    ++incomplete;
    EXPECT_EQ(r.why, "evaluated 4 of 4 poses over 33.3 % of the reference's time, below 50.0 %");
  }
  EXPECT_EQ(incomplete, 3);
  for (const Record& r : records) {  // a failed metric remains failed
    if (r.kind->label == "undefined") {
      EXPECT_EQ(r.status, Status::failed);
    }
  }
}

TEST_F(RunSweep, ACellIsIncompleteOnlyAtTheTimesThatAre) {
  known_.datasets[0].load = [](const Params& given, const DataRoot& root) {
    Sequence out = load_line(with(LineOptions{}, given), root);
    out.reference.erase(out.reference.begin() + 1, out.reference.begin() + 3);
    return out;  // two of four keyframes are paired; dense evaluates both reference stamps
  };
  sweep_.protocols.front().rules.align = Align::none;
  sweep_.min_coverage = 0.9;
  sweep_.times = {Times::keyframes, Times::dense};
  for (const Record& r : run()) {
    if (r.cell->method != "straight" || r.kind->label != "ate") continue;
    EXPECT_EQ(r.status, r.kind->times == "dense" ? Status::ok : Status::incomplete);
  }
}

TEST_F(RunSweep, AMetricThatMeansNothingHereIsDeclinedNotFailed) {
  known_.metrics[0].score = [](const Evaluation&, const Params&) -> std::vector<Score> {
    throw Undefined("no closures");
  };
  int declined = 0;
  for (const Record& r : run()) {
    if (r.why != "no closures") continue;
    EXPECT_EQ(r.status, Status::declined);
    ++declined;
  }
  EXPECT_EQ(declined, 36);
}

TEST_F(RunSweep, AnUndefinedNumberIsDeclinedAloneAndSaysWhy) {
  known_.metrics[0].score = [](const Evaluation& evaluation, const Params&) {
    EXPECT_NE(evaluation.context.problem, nullptr);
    EXPECT_NE(evaluation.context.curve, nullptr);
    EXPECT_EQ(evaluation.context.estimate->size(), 4u);
    return std::vector<Score>{{"rotation", "3d", "deg", {}, "positions only"},
                              single("translation", "3d", "m", -2.0)};
  };
  for (const Record& r : run()) {
    if (r.cell->method != "straight" || r.kind->label != "ate") continue;
    EXPECT_EQ(r.status, r.kind->relation == "rotation" ? Status::declined : Status::ok);
    EXPECT_EQ(r.why, r.kind->relation == "rotation" ? "positions only" : "");
    EXPECT_EQ(r.statistics.rmse, r.kind->relation == "rotation" ? 0.0 : -2.0);
  }
}

}  // namespace
}  // namespace loopbench::tiny::run_test
