/// Pass and fail conditions of the gate.
#include "harness/answers/gate/gate.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/gate_snapshot.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::gate_snapshot::gate_test {
namespace {

TEST(Gate, NamesTheCellWhoseNumberMovedBeyondItsLimit) {
  const GateReport report = after([](Snapshot& now) { rmse(now, 3) *= 1.0011; });
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_FALSE(report.passes());
  EXPECT_EQ(report.findings[0].cell, "room (repeat 1) / uniform");
  EXPECT_EQ(report.findings[0].score, "ate translation 3d, dense, loopbench");
  EXPECT_EQ(report.findings[0].what, "rmse 0.550605 m, was 0.55 (+0.11 %, limit 0.000551)");
  EXPECT_TRUE(after([](Snapshot& now) { rmse(now, 3) *= 1.0009; }).findings.empty());
}

TEST(Gate, ReportsImprovementsAndPasses) {
  const GateReport report = after([](Snapshot& now) { rmse(now, 3) *= 0.5; });
  EXPECT_TRUE(report.passes());
  EXPECT_EQ(report.count(Finding::Kind::improvement), 1u);
}

TEST(Gate, TellsCellsWithEqualNamesApart) {
  Baseline before = baseline();
  std::vector<Record>& records = before.snapshot.records;
  for (const char* const sequence : {"room (repeat 1)", "room / raw"}) {
    for (std::size_t cell = 0; cell < 2; ++cell) {
      Record other = sweep().records[cell];
      other.cell.edit().sequence = sequence;
      if (other.cell->method == "uniform") other.cell.edit().method = "raw / uniform";
      records.push_back(other);
    }
  }
  records.push_back(ate(0, "raw / raw", 0.1));  // as "room / raw" of raw
  Snapshot now = before.snapshot;
  EXPECT_TRUE(check(before, now).findings.empty());
  rmse(now, 16) *= 2.0;
  const GateReport report = check(before, now);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].cell, "room (repeat 1) / raw");
  EXPECT_EQ(report.cells, 21u);
}

TEST(Gate, FailsOnWhatFailsNewly) {
  EXPECT_FALSE(after([](Snapshot& now) { fail(now, 0, Status::ok); }).passes());
  for (const Status status :
       {Status::failed, Status::crashed, Status::timeout, Status::declined, Status::incomplete}) {
    const GateReport report = after([&](Snapshot& now) {
      if (status != Status::incomplete) now.records[0].kind = {};
      now.records[0].status = status;
    });
    ASSERT_EQ(report.findings.size(), 1u) << to_text(status);
    EXPECT_EQ(report.findings[0].what, "was ok, is " + to_text(status));
  }
  const GateReport score = after([](Snapshot& now) { now.records[0].status = Status::failed; });
  EXPECT_EQ(score.findings.at(0).score, "ate translation 3d, dense, loopbench");
  const GateReport pairs = after([](Snapshot& now) { now.records[0].pairs = 399; });
  EXPECT_EQ(pairs.findings.at(0).what, "evaluated 399 of 400 possible pose pairs, was 400 of 400");
}

TEST(Gate, HasOneFindingForAMethodThatFailsEverywhere) {
  const GateReport report = after([](Snapshot& now) {
    for (std::size_t cell = 1; cell < 16; cell += 2) {
      fail(now, cell, Status::crashed);
      now.records[cell].why = "segmentation fault";
    }
  });
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].cell, "uniform");
  EXPECT_EQ(report.findings[0].what,
            "fails on all 8 cells; room / uniform: crashed: segmentation fault");
  EXPECT_EQ(report.failed.size(), 8u);
  EXPECT_FALSE(report.passes());
}

TEST(Gate, ReportsSmallDifferencesOfAnUnsteadyMethodAsNotDeterministic) {
  const auto noisy = [](double factor) {
    return after([&](Snapshot& now) {
      for (std::size_t cell = 1; cell < 16; cell += 2) {
        rmse(now, cell) *= cell % 4 == 1 ? factor : 1.0;
        now.records[cell].cell.edit().notes = {{.kind = NoteKind::nondeterministic}};
      }
    });
  };
  const GateReport report = noisy(1.01);
  EXPECT_TRUE(report.passes());
  EXPECT_TRUE(report.findings.empty());
  EXPECT_EQ(std::ranges::count(report.notes,
                               "not deterministic: uniform: runs on equal input differ, so that "
                               "differences of up to 1 % from the baseline are no finding"),
            1);
  EXPECT_EQ(noisy(1.2).count(Finding::Kind::regression), 4u);
}

TEST(Gate, ReportsWhatIsNewOrWorksAgain) {
  const GateReport added = after([](Snapshot& now) {
    now.records.push_back(ate(0, "dual", 0.1));
    now.sequences["city"] = "path=city";
  });
  EXPECT_TRUE(added.passes());
  EXPECT_EQ(added.findings.at(0).kind, Finding::Kind::added);
  EXPECT_EQ(added.findings.at(0).cell, "room / dual");
  Baseline broken = baseline();
  fail(broken.snapshot, 0, Status::failed);
  const GateReport repaired = check(broken, sweep());
  EXPECT_TRUE(repaired.passes());
  EXPECT_EQ(repaired.findings.at(0).kind, Finding::Kind::improvement);
}

TEST(Gate, HoldsTheFirstLimitThatKeepsAScore) {
  Baseline strict = baseline();
  strict.limits = {{.where = {"method=raw"}, .values = {"rmse"}, .relative = 1e-9, .absolute = 0.0},
                   {.where = {}, .values = {"rmse"}, .relative = 0.5, .absolute = 0.0}};
  Snapshot now = sweep();
  rmse(now, 0) += 1e-6;
  rmse(now, 1) *= 1.4;
  const GateReport report = check(strict, now);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].cell, "room / raw");
}

TEST(Gate, RejectsLimitsThatSelectNoScore) {
  const auto with = [](std::vector<Tolerance> limits) {
    return refusal_of([&] {
      Baseline loose = baseline();
      loose.limits = std::move(limits);
      check(loose, sweep());
    });
  };
  EXPECT_EQ(with({}), "limits: is empty, so that every change would pass; expected at least one");
  EXPECT_EQ(with({rmse_alone(), {.where = {"metric=atee", "axis=3d"}}}),
            "limits[1].where: 'metric=atee, axis=3d' selects no score of the baseline");
  EXPECT_EQ(with({rmse_alone()}), "");
}

TEST(Gate, CountsScoresWithoutALimit) {
  Baseline raw = baseline();
  raw.limits[0].where = {"method=raw", "repeat=3"};
  const GateReport report = check(raw, sweep());
  EXPECT_EQ(report.scores, 1u);
  ASSERT_FALSE(report.notes.empty());
  EXPECT_EQ(std::ranges::count(report.notes, "15 scores have no limit"), 1);
}

TEST(Gate, TakesAnyMoveOfADescriptionForALoss) {
  Baseline counted = baseline();
  for (Record& r : counted.snapshot.records) r.kind.edit().better = Better::neither;
  Snapshot now = counted.snapshot;
  rmse(now, 0) *= 0.9;
  EXPECT_EQ(check(counted, now).count(Finding::Kind::regression), 1u);
}

TEST(Gate, MissesNoCellOfAPart) {
  Snapshot part = sweep();
  part.records.resize(4);
  EXPECT_EQ(check(baseline(), part).count(Finding::Kind::regression), 12u);
  const GateReport report = check(baseline(), part, GateExtent::part);
  EXPECT_TRUE(report.findings.empty());
  EXPECT_EQ(report.cells, 4u);
  rmse(part, 3) *= 2.0;
  EXPECT_FALSE(check(baseline(), part, GateExtent::part).passes());
}

TEST(Gate, LooksAtTimesOnlyWhenALimitIsAboutThem) {
  EXPECT_FALSE(limits_time({Tolerance{}}));
  Baseline timed = baseline();
  timed.limits.insert(timed.limits.begin(), time_limits(0.5).front());
  EXPECT_TRUE(limits_time(timed.limits));
  const auto add_times = [](Snapshot& to, double ms) {
    std::vector<Record> all;
    for (const Record& r : to.records) {
      all.push_back(r);
      all.push_back(r);
      all.back().kind.edit().metric = "cpu_ms";
      all.back().statistics.rmse = ms;
    }
    to.records = all;
  };
  add_times(timed.snapshot, 10.0);
  Snapshot now = sweep();
  add_times(now, 10.9);  // within the limit
  EXPECT_TRUE(check(timed, now).findings.empty());
  now.records[3].statistics.rmse = 16.1;
  const GateReport slow = check(timed, now);
  ASSERT_EQ(slow.findings.size(), 1u);
  EXPECT_EQ(slow.findings[0].what, "rmse 16.1 m, was 10 (+61 %, limit 6)");
  now.records[3].statistics.rmse = 0.01;  // fast, not implausible
  const GateReport fast = check(timed, now);
  EXPECT_EQ(fast.count(Finding::Kind::improvement), 1u);
  EXPECT_EQ(
      std::ranges::count_if(
          fast.notes, [](const std::string& note) { return note.starts_with("implausible"); }),
      0);
}

TEST(Gate, RefusesAnotherSweepEvenWhereAPartWouldDo) {
  Baseline other = baseline();
  other.snapshot.sweep = "outliers";
  for (Record& r : other.snapshot.records) r.cell.edit().sequence = "street";
  for (const GateExtent extent : {GateExtent::complete, GateExtent::part}) {
    EXPECT_EQ(refusal_of([&] { check(other, sweep(), extent); }),
              "the baseline is from another sweep: the results contain no cell of 'outliers'");
  }
}

}  // namespace
}  // namespace loopbench::gate_snapshot::gate_test
