/// Regressions planted into a sweep: the gate must detect and name each of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "datasets/core/error.hpp"
#include "harness/answers/gate/gate.hpp"
#include "harness/answers/tables/gate_table.hpp"
#include "tests/support/compared_sweep.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::compared_sweep::planted_regressions_test {
namespace {

/// A sweep for the gate: two methods on eight repeats, with records as read from a store.
Record score(int run, const std::string& method, const std::string& metric, double rmse) {
  Record out = compared_sweep::score("room", run, method, rmse);
  out.cell.edit().position = 2 * run + (method == "raw" ? 0 : 1);
  out.kind.edit().metric = out.kind.edit().label = metric;
  out.statistics.max = 2.0 * rmse;
  out.statistics.count = 400;
  out.pairs = out.possible = 400;
  return out;
}

/// ATE 1.0, 1.1, ... for raw and half of it for uniform; the RPE is a tenth of the ATE.
std::vector<Record> records() {
  std::vector<Record> out;
  for (int run = 0; run < 8; ++run) {
    const double error = 1.0 + 0.1 * run;
    for (const auto& [method, share] : {std::pair{"raw", 1.0}, std::pair{"uniform", 0.5}}) {
      out.push_back(score(run, method, "ate", share * error));
      out.push_back(score(run, method, "rpe", 0.1 * share * error));
    }
  }
  return out;
}

/// The definitions for the records.
Snapshot snapshot_of(const std::vector<Record>& records) {
  Snapshot out;
  out.sweep = "quick";
  out.machine = "GNU 12.2.0, one CPU";
  out.sequences = {{"room", "simulated: path=room, seed=1; a.txt 3 beef"}};
  out.protocols = {{"loopbench [2]", "align=se3, max_diff=0.02"}};
  out.metrics = {{"ate", "ate"}, {"rpe", "rpe, delta=1.0, unit=frames"}};
  out.methods = {{"raw", "raw"}, {"uniform", "uniform, rotation=slerp, weights=time"}};
  out.records = checked_records(records, {Tolerance{}});
  return out;
}

Baseline baseline() {
  return {{{"compiler", "GNU 12.2.0"}, {"source", "clean"}}, {Tolerance{}}, snapshot_of(records())};
}

/// The report as text, or the reason why the baseline does not apply; empty if it passes.
std::string caught(const Snapshot& now, const Baseline& before = baseline()) {
  std::string out;
  try {
    // Through a file: values that are not written cannot be checked.
    const GateReport report = check(parse_baseline(json(before), "b.json"), now);
    if (!report.passes()) out = markdown(report, "quick");
  } catch (const InputError& error) {
    out = error.what();
  }
  return out;
}

void expect_named(const std::string& report, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    EXPECT_NE(report.find(name), std::string::npos) << name << " is not in:\n" << report;
  }
}

TEST(PlantedRegression, NothingPlantedPasses) { EXPECT_EQ(caught(snapshot_of(records())), ""); }

TEST(PlantedRegression, OfEveryRecord) {
  const auto changed = [](void (*change)(Record&)) {
    std::vector<Record> now = records();
    std::ranges::for_each(now, change);
    return caught(snapshot_of(now));
  };
  expect_named(
      changed([](Record& r) { r.kind.edit().metric = r.kind->label == "ate" ? "ape" : "rpe"; }),
      {"metric 'ape', unit 'm', best value: lower; was metric 'ate', "});
  expect_named(changed([](Record& r) { r.cell.edit().oracle = r.cell->method == "uniform"; }),
               {"room / uniform", "oracle: the method or its data uses the reference, was not"});
  expect_named(changed([](Record& r) { r.cell.edit().oracle_closures = true; }),
               {"room / raw", "oracle: closures are measured in the reference, was not"});
  expect_named(changed([](Record& r) { r.kind.edit().unit = "cm"; }),
               {"unit 'cm', best value: lower; was ", "unit 'm'"});
  expect_named(changed([](Record& r) { r.kind.edit().better = Better::higher; }),
               {"best value: higher; was ", "best value: lower"});
}

TEST(PlantedRegression, OfOneCell) {
  const auto changed = [](std::size_t record, void (*change)(Record&)) {
    std::vector<Record> now = records();
    change(now[record]);
    return caught(snapshot_of(now));
  };
  expect_named(changed(3, [](Record& r) { r.statistics.count = 1; }),
               {"room / uniform", "rpe translation", "statistics over 1 errors, was 400"});
  expect_named(changed(2, [](Record& r) { r.statistics.max *= 1.01; }),
               {"room / uniform", "max 1.01 m, was 1 (+1 %"});
  expect_named(changed(2, [](Record& r) { r.statistics.rmse = std::nan(""); }),
               {"room / uniform", "rmse nan m, was 0.5"});
  expect_named(changed(2, [](Record& r) { r.possible = 4000; }),
               {"room / uniform", "evaluated 400 of 4000 possible pose pairs, was 400 of 400"});
}

TEST(PlantedRegression, AnIncompleteCellWithAThousandTimesTheError) {
  std::vector<Record> before = records();
  before[2].status = Status::incomplete;
  Baseline incomplete = baseline();
  incomplete.snapshot = snapshot_of(before);
  EXPECT_EQ(caught(snapshot_of(before), incomplete), "");
  std::vector<Record> now = before;
  now[2].statistics.rmse *= 1000.0;
  expect_named(caught(snapshot_of(now), incomplete), {"room / uniform", "rmse 500 m, was 0.5"});
}

TEST(PlantedRegression, AMethodASequenceOrAScoreThatVanished) {
  const auto without = [](bool (*is_gone)(const Record&)) {
    std::vector<Record> now = records();
    std::erase_if(now, is_gone);
    return caught(snapshot_of(now));
  };
  expect_named(without([](const Record& r) { return r.cell->method == "uniform"; }),
               {"room (repeat 7) / uniform", "missing"});
  expect_named(without([](const Record& r) { return r.cell->repeat == 3; }),
               {"room (repeat 3) / raw", "missing"});
  expect_named(without([](const Record& r) { return r.kind->metric == "rpe"; }),
               {"rpe translation 3d, dense, loopbench", "missing"});
}

TEST(PlantedRegression, OtherContentOfTheDataset) {
  std::vector<Record> now = records();
  Baseline hashed = baseline();
  hashed.snapshot.contents = {{"room", "beef"}};
  Snapshot other = snapshot_of(now);
  other.contents = {{"room", "cafe"}};
  expect_named(caught(other, hashed), {"different data for the sequence 'room'", "beef", "cafe"});
  other.machine = "another CPU";  // last digits can differ
  EXPECT_EQ(caught(other, hashed), "");
  expect_named(markdown(check(hashed, other), "quick"), {"contents of sequences are not compared"});
}

TEST(PlantedRegression, ABaselineOfAnUncommittedBuild) {
  EXPECT_FALSE(is_dirty(baseline().build_summary));
  EXPECT_TRUE(is_dirty({{"source", "dirty"}}));
  EXPECT_TRUE(is_dirty({{"source", "clean\ndirty"}}));  // cells of two builds
}

}  // namespace
}  // namespace loopbench::compared_sweep::planted_regressions_test
