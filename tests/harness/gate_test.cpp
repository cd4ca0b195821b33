/// What passes the gate, what does not, and how it is told.
#include "harness/export/gate.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "datasets/core/error.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench {
namespace {

GateScore ate(double rmse) {
  return {"loopbench", "dense", "ate", "translation", "3d", "m", "ok", 400, {{"rmse", rmse}}};
}

/// Two methods on eight repeats; errors 1.0, 1.1, ... and half of that.
Snapshot sweep() {
  Snapshot out{"quick", {{"room", "path=room"}}, {{"loopbench [1]", "align=se3"}}, {}};
  for (int repeat = 0; repeat < 8; ++repeat) {
    const double error = 1.0 + 0.1 * repeat;
    out.cells.push_back({"room", repeat, "raw", "ok", {ate(error)}});
    out.cells.push_back({"room", repeat, "uniform", "ok", {ate(0.5 * error)}});
  }
  return out;
}

Baseline baseline() { return {{{"compiler", "g++ 12.2"}}, {Tolerance{}}, sweep()}; }

GateReport after(const std::function<void(Snapshot&)>& change) {
  Snapshot now = sweep();
  change(now);
  return check(baseline(), now);
}

double& rmse(Snapshot& of, std::size_t cell) { return of.cells[cell].scores[0].values["rmse"]; }

TEST(Gate, PassesTheSameNumbers) {
  const GateReport report = after([](Snapshot&) {});
  EXPECT_TRUE(report.passes());
  EXPECT_TRUE(report.findings.empty());
  EXPECT_EQ(report.cells, 16u);
  EXPECT_EQ(report.scores, 16u);
}

TEST(Gate, NamesTheCellWhoseNumberMovedBeyondItsLimit) {
  const GateReport report = after([](Snapshot& now) { rmse(now, 3) *= 1.0011; });
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_FALSE(report.passes());
  EXPECT_EQ(report.findings[0].cell, "room (repeat 1) / uniform");
  EXPECT_EQ(report.findings[0].score, "ate translation 3d, dense, loopbench");
  EXPECT_EQ(report.findings[0].what, "rmse 0.550605 m, was 0.55 (+0.11 %, may move 0.000551)");
  EXPECT_TRUE(after([](Snapshot& now) { rmse(now, 3) *= 1.0009; }).findings.empty());
}

TEST(Gate, ReportsImprovementsAndPasses) {
  const GateReport report = after([](Snapshot& now) { rmse(now, 3) *= 0.5; });
  EXPECT_TRUE(report.passes());
  EXPECT_EQ(report.count(Finding::Kind::improvement), 1u);
}

TEST(Gate, FailsOnWhatVanishedOrFailsNewly) {
  EXPECT_FALSE(after([](Snapshot& now) { now.cells.pop_back(); }).passes());
  EXPECT_FALSE(after([](Snapshot& now) { now.cells[0].scores.clear(); }).passes());
  for (const char* status : {"failed", "crashed", "timeout", "declined", "incomplete"}) {
    const GateReport report = after([&](Snapshot& now) {
      now.cells[0].status = status;
      now.cells[0].scores.clear();
    });
    ASSERT_EQ(report.findings.size(), 1u) << status;
    EXPECT_EQ(report.findings[0].what, std::string("was ok, is ") + status);
  }
  const GateReport score = after([](Snapshot& now) { now.cells[0].scores[0].status = "failed"; });
  EXPECT_EQ(score.findings.at(0).score, "ate translation 3d, dense, loopbench");
  const GateReport pairs = after([](Snapshot& now) { now.cells[0].scores[0].pairs = 399; });
  EXPECT_EQ(pairs.findings.at(0).what, "judged 399 pose pairs, was 400");
}

TEST(Gate, ReportsWhatIsNewOrWorksAgain) {
  const GateReport added = after([](Snapshot& now) {
    now.cells.push_back({"room", 0, "dual", "ok", {ate(0.1)}});
    now.sequences["city"] = "path=city";
  });
  EXPECT_TRUE(added.passes());
  EXPECT_EQ(added.findings.at(0).kind, Finding::Kind::added);
  EXPECT_EQ(added.findings.at(0).cell, "room / dual");
  Baseline broken = baseline();
  broken.snapshot.cells[0].status = "failed";
  const GateReport repaired = check(broken, sweep());
  EXPECT_TRUE(repaired.passes());
  EXPECT_EQ(repaired.findings.at(0).kind, Finding::Kind::improvement);
}

TEST(Gate, FindsALossTooSmallForAnyOneNumber) {
  const auto creep = [](double by) {
    return after([&](Snapshot& now) {
      for (std::size_t cell = 1; cell < 16; cell += 2) rmse(now, cell) *= 1.0 + by;
    });
  };
  const GateReport report = creep(5e-4);  // half the limit, on all eight runs of uniform
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_FALSE(report.passes());
  EXPECT_EQ(report.findings[0].cell, "uniform");
  // One-sided 2^-8, twice for two methods.
  EXPECT_EQ(report.findings[0].what, "rmse worse over 8 runs, by 0.05 % on average: p = 0.0078");
  EXPECT_TRUE(creep(-5e-4).findings.empty());
  EXPECT_TRUE(creep(5e-7).findings.empty());  // another compiler's last digits
}

TEST(Gate, HoldsTheFirstLimitThatKeepsAScore) {
  Baseline strict = baseline();
  strict.limits = {{.where = {"method=raw"}, .relative = 1e-9, .absolute = 0.0, .alpha = {}},
                   {.where = {}, .relative = 0.5, .absolute = 0.0, .alpha = {}}};
  Snapshot now = sweep();
  rmse(now, 0) += 1e-6;
  rmse(now, 1) *= 1.4;
  const GateReport report = check(strict, now);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].cell, "room / raw");
}

TEST(Gate, TakesAnyMoveOfADescriptionForALoss) {
  Baseline counted = baseline();
  for (GateCell& cell : counted.snapshot.cells) cell.scores[0].better = Better::neither;
  Snapshot now = counted.snapshot;
  rmse(now, 0) *= 0.9;
  EXPECT_EQ(check(counted, now).count(Finding::Kind::regression), 1u);
}

TEST(Gate, MissesNoCellOfAPart) {
  Snapshot part = sweep();
  part.cells.resize(4);
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
  timed.limits.insert(timed.limits.begin(), time_limit(0.5));
  EXPECT_TRUE(limits_time(timed.limits));
  timed.limits[0].alpha = 0.05;  // eight runs cannot show less after Holm over four tests
  const auto add_times = [](Snapshot& to, double ms) {
    for (GateCell& cell : to.cells) {
      cell.scores.push_back(ate(ms));
      cell.scores.back().metric = "time";
    }
  };
  add_times(timed.snapshot, 10.0);
  Snapshot now = sweep();
  add_times(now, 10.9);  // within the limit, and less than the tenth that a test takes for a move
  EXPECT_TRUE(check(timed, now).findings.empty());
  now.cells[1].scores.back().values["rmse"] = 16.1;
  const GateReport slow = check(timed, now);
  ASSERT_EQ(slow.findings.size(), 1u);
  EXPECT_EQ(slow.findings[0].what, "rmse 16.1 m, was 10 (+61 %, may move 6)");
  now = sweep();
  add_times(now, 12.0);  // a fifth on all runs
  EXPECT_FALSE(check(timed, now).passes());
}

TEST(Gate, TellsTheOptionsThatDiffer) {
  const auto with = [](const std::string& text) {
    return refusal_of([&] {
      Baseline old = baseline();
      old.snapshot.sequences["room"] = "simulated: laps=1, path=room; a.txt 3 beef";
      Snapshot now = sweep();
      now.sequences["room"] = text;
      check(old, now);
    });
  };
  EXPECT_EQ(with("simulated: laps=2, path=room; a.txt 3 beef"),
            "the baseline is of another sequence 'room': it has 'simulated: laps=1', these "
            "results have 'simulated: laps=2'");
  EXPECT_EQ(with("simulated: laps=1, path=room; a.txt 3 cafe"),
            "the baseline is of another sequence 'room': it has 'a.txt 3 beef', these results "
            "have 'a.txt 3 cafe'");
}

TEST(Gate, RefusesOtherInputsAndProtocols) {
  EXPECT_EQ(refusal_of([] { after([](Snapshot& now) { now.sequences["room"] = "path=city"; }); }),
            "the baseline is of another sequence 'room': it has 'path=room', these results have "
            "'path=city'");
  EXPECT_NE(refusal_of([] { after([](Snapshot& now) { now.protocols.clear(); }); }), "");
  EXPECT_NE(refusal_of([] { after([](Snapshot& n) { n.protocols["loopbench [1]"] = ""; }); }), "");
  EXPECT_EQ(refusal_of([] { after([](Snapshot& now) { now.sequences.clear(); }); }), "");
}

TEST(Gate, RefusesAnotherSweepEvenWhereAPartWouldDo) {
  Baseline other = baseline();
  other.snapshot.sweep = "outliers";
  for (GateCell& cell : other.snapshot.cells) cell.sequence = "street";
  for (const GateExtent extent : {GateExtent::whole, GateExtent::part}) {
    EXPECT_EQ(refusal_of([&] { check(other, sweep(), extent); }),
              "the baseline is of another sweep: no cell of 'outliers' is among these results");
  }
}

TEST(BaselineFile, ReadsBackWhatWasWritten) {
  Baseline before = baseline();
  before.snapshot.cells[0].scores.clear();
  before.snapshot.cells[0].status = "failed";
  before.snapshot.cells[2].scores[0].status = "declined";
  before.snapshot.cells[2].scores[0].pairs = 0;
  before.snapshot.cells[2].scores[0].values.clear();
  rmse(before.snapshot, 1) = 1.0 / 3.0;
  before.snapshot.cells[3].method = "a\"b\n<c>";
  const std::string text = json(before);
  const Baseline read = parse_baseline(text, "b.json");
  EXPECT_EQ(json(read), text);
  EXPECT_EQ(rmse(const_cast<Baseline&>(read).snapshot, 1), 1.0 / 3.0);
  EXPECT_TRUE(check(before, read.snapshot).findings.empty());
  EXPECT_EQ(read.made_by, before.made_by);
  EXPECT_EQ(read.limits[0].alpha, before.limits[0].alpha);
}

TEST(BaselineFile, IsRefusedWithItsPlace) {
  const std::string good = json(baseline());
  const auto refusal = [](const std::string& text) {
    return refusal_of([&] { parse_baseline(text, "b.json"); });
  };
  EXPECT_EQ(refusal(""), refusal(""));
  EXPECT_EQ(refusal("{\n\"sweep\": \n]").find("b.json:3: is not JSON: "), 0u)
      << refusal("{\n\"sweep\": \n]");
  EXPECT_EQ(refusal("").find("b.json:1: is not JSON: "), 0u);
  EXPECT_EQ(refusal("[]"), "b.json: baseline: expected an object");
  EXPECT_EQ(refusal("{}"), "b.json: loopbench_baseline: is missing");
  EXPECT_EQ(refusal("{\"loopbench_baseline\": 9}"),
            "b.json: loopbench_baseline: is 9, expected 2; --update writes it anew");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return refusal(text.replace(at, from.size(), to));
  };
  EXPECT_EQ(changed("\"rmse\":[1.0]", "\"rmse\":[\"1\"]"),
            "b.json: cells[0].rmse[0]: expected a number, found \"1\"");
  EXPECT_EQ(changed("\"pairs\":[400]", "\"pairs\":[]"),
            "b.json: cells[0].pairs: expected a list of 1, as scores");
  EXPECT_EQ(changed("\"value\":\"rmse\"", "\"value\":\"rms\""),
            "b.json: limits[0]: no statistic is named 'rms'; did you mean 'rmse'?");
  EXPECT_EQ(changed("\"relative\":0.001", "\"relative\":-1"),
            "b.json: limits[0].relative: expected a number, not negative, found -1");
  EXPECT_EQ(changed("\"sequence\":\"room\"", "\"sequence\":3"),
            "b.json: cells[0].sequence: expected text, found 3");
}

TEST(GateText, IsMarkdownAndJUnit) {
  const GateReport report = after([](Snapshot& now) {
    rmse(now, 3) *= 2.0;
    now.cells[0].method = "ra<w>&\"";
  });
  const std::string text = markdown(report, "quick");
  EXPECT_EQ(text.find("### quick: FAILS\n\n| cell "), 0u) << text;
  EXPECT_NE(text.find("| room / raw                |"), std::string::npos) << text;
  EXPECT_NE(text.find("- 2 regressions, 0 improvements, 1 new cell in 16 cells and 15 scores\n"),
            std::string::npos)
      << text;
  const std::string xml = junit(report, "quick");
  EXPECT_NE(xml.find("<testsuite name=\"loopbench check quick\" tests=\"16\" failures=\"2\""),
            std::string::npos)
      << xml;
  EXPECT_NE(
      xml.find("<testcase classname=\"quick\" name=\"room (repeat 1) / uniform\">\n"
               "    <failure message=\"1 regression\">ate translation 3d, dense, loopbench: "),
      std::string::npos)
      << xml;
  Baseline odd = baseline();
  odd.snapshot.cells[0].method = "ra<w>&\"";
  EXPECT_NE(junit(check(odd, sweep()), "q").find("name=\"room / ra&lt;w&gt;&amp;&quot;\""),
            std::string::npos);
  EXPECT_EQ(markdown(after([](Snapshot&) {}), "quick"),
            "### quick: passes\n\n"
            "- 0 regressions, 0 improvements, 0 new cells in 16 cells and 16 scores\n");
}

}  // namespace
}  // namespace loopbench
