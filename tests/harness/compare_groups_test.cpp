/// Observations: failures, groups, copies; and remarks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/compared_sweep.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::compared_sweep::compare_groups_test {
namespace {

bool has_note(const Comparison& c, const std::string& text) {
  return std::ranges::count_if(remarks(c),
                               [&](const std::string& line) { return has(line, text); }) == 1;
}

std::string legend_of(const Comparison& c) { return verdict_of(c, {}).legend; }

/// Twenty sequences; `good` is 55 % below raw on the first ten and fails as `status` on the rest.
std::vector<Record> failing(const std::string& status) {
  std::vector<Record> out;
  for (int i = 0; i < 20; ++i) {
    const std::string sequence = std::to_string(i);
    out.push_back(score(sequence, 0, "raw", 1.0 + 0.1 * i));
    out.push_back(score(sequence, 0, "good", 0.45 * (1.0 + 0.1 * i)));
    if (i < 10) continue;
    if (status == "nan") {
      out.back().statistics.rmse = std::nan("");
    } else {
      out.back() = failed(sequence, 0, "good");
      out.back().status = from_text<Status>(status).value();
    }
  }
  return out;
}

TEST(Failures, AreCountedBesideTheNumbers) {
  for (const char* status : {"failed", "crashed", "timeout", "out_of_memory", "nan"}) {
    const Comparison c = compared(failing(status), {.baseline = "raw"});
    EXPECT_FALSE(c.is_best) << status;
    EXPECT_EQ(c.runs, 20u);
    const auto good = std::ranges::find(c.methods, "good", &MethodVerdict::method);
    EXPECT_EQ(good->wins, 10u);
    EXPECT_EQ(good->losses, 0u);
    EXPECT_EQ(good->fails, 10u);
    EXPECT_NEAR(good->ratio->typical.estimate, 0.45, 1e-9);
    EXPECT_FALSE(good->beats_baseline);  // it is shown to fail more often
    EXPECT_TRUE(has_note(c, "no value on 10 of 20 runs (")) << status;
    EXPECT_TRUE(
        sentence(c).ends_with(" on 10 of 20 runs; good fails on 10 (significantly more often)"))
        << sentence(c);
  }
}

TEST(Failures, AreNoGainOfTheMethodThatFails) {
  std::vector<Record> records;  // `same` equals raw, but fails on 12 of 16
  for (int i = 0; i < 16; ++i) {
    const std::string sequence = std::to_string(i);
    records.push_back(score(sequence, 0, "raw", 1.0 + i));
    records.push_back(i < 12 ? failed(sequence, 0, "same") : score(sequence, 0, "same", 1.0 + i));
  }
  const Comparison c = compared(records, {.baseline = "raw"});
  EXPECT_EQ(c.methods[0].method, "raw");
  EXPECT_EQ(sentence(c),
            "the baseline raw is best: same is 0.0 % below raw (too few runs for a test) on 4 of "
            "16 runs; same fails on 12 "
            "(significantly more often)");
}

TEST(Failures, OfRunsThatAnotherSolvesLeaveNoMethodFirstAlone) {
  std::vector<Record> records;
  for (int i = 0; i < 20; ++i) {
    const std::string sequence = std::to_string(i);
    records.push_back(score(sequence, 0, "raw", 1.0 + i));
    records.push_back(i < 1 ? failed(sequence, 0, "good")
                            : score(sequence, 0, "good", 0.5 + 0.4 * i));
  }
  const Comparison c = compared(records, {.baseline = "raw"});
  EXPECT_FALSE(c.is_best) << sentence(c);
  EXPECT_TRUE(sentence(c).starts_with("no method is best: good is 5")) << sentence(c);
  EXPECT_TRUE(sentence(c).ends_with(" on 19 of 20 runs; good fails on 1")) << sentence(c);
  EXPECT_TRUE(
      has_note(c, "no value on 1 of 20 runs (failed 1); changes are over the runs that both"));
}

TEST(Failures, AreNotRunsThatWereNeverMade) {
  std::vector<Record> records = sweep();
  std::erase_if(records,
                [](const Record& r) { return r.cell->method == "dual" && r.cell->repeat == 0; });
  records.push_back(failed("room", 0, "broken"));
  const Comparison c = compared(records);
  EXPECT_EQ(c.runs, 8u);  // of the other methods
  EXPECT_EQ(c.methods[0].wins, 6u);
  EXPECT_TRUE(has_note(c, "no value on 2 of 8 runs (not run 2): dual"));
  EXPECT_TRUE(has_note(c, "not ranked, no value (failed 1, not run 7): broken"));
}

TEST(Failures, OfAMetricAreNotTheMethods) {
  std::vector<Record> records = sweep();
  const auto fails = [&] {
    const Comparison c = compared(records);
    return std::pair{c.runs, std::ranges::find(c.methods, "dual", &MethodVerdict::method)->fails};
  };
  records[2].status = Status::declined;
  EXPECT_EQ(fails(), (std::pair{std::size_t{8}, std::size_t{0}}));
  records[2].status = Status::incomplete;
  EXPECT_EQ(fails(), (std::pair{std::size_t{8}, std::size_t{1}}));
}

/// Five odometers on each of `routes` routes, with an effect per route: dual is better on `won` of
/// them.
std::vector<Record> routes(int routes, int won) {
  std::vector<Record> out;
  for (int route = 0; route < routes; ++route) {
    for (int odometer = 0; odometer < 5; ++odometer) {
      const std::string sequence = std::to_string(route) + " " + std::to_string(odometer);
      const double factor = (route < won ? 0.8 : 1.05) + 0.01 * odometer + 0.005 * route;
      for (const char* method : {"raw", "dual"}) {
        out.push_back(score(sequence, 0, method, method[0] == 'd' ? factor : 1.0));
        out.back().cell.edit().group = "route " + std::to_string(route);
      }
    }
  }
  return out;
}

TEST(Groups, AreTheObservations) {
  const Comparison c = compared(routes(8, 5), {.baseline = "raw"});
  EXPECT_EQ(c.groups, 8u);
  EXPECT_EQ(c.runs, 40u);
  EXPECT_EQ(c.methods[0].wins, 5u);
  EXPECT_FALSE(c.is_best);
  EXPECT_TRUE(has(legend_of(c), " over 8 groups (40 runs); ")) << legend_of(c);
}

TEST(Groups, WeighTheSameWhateverTheirRuns) {
  std::vector<Record> records = routes(6, 6);
  std::erase_if(records, [](const Record& r) {
    return r.cell->sequence.text()[0] == '0' && r.cell->sequence != "0 0";
  });
  double expected = 0.0;
  for (int route = 0; route < 6; ++route) {
    double of_route = 0.0;
    const int odometers = route == 0 ? 1 : 5;
    for (int o = 0; o < odometers; ++o) of_route += std::log(0.8 + 0.01 * o + 0.005 * route);
    expected += of_route / odometers / 6.0;
  }
  const Comparison c = compared(records, {.baseline = "raw"});
  EXPECT_NEAR(*c.methods[0].ratio->geometric_mean, std::exp(expected), 1e-12);
}

TEST(Groups, GiveNoPWhereTheyAreTooFew) {
  const Comparison c = compared(routes(5, 5), {.baseline = "raw"});
  EXPECT_FALSE(c.methods[0].p);
  EXPECT_FALSE(c.is_best);
  EXPECT_TRUE(
      sentence(c).starts_with("5 groups (25 runs) cannot decide between 2 methods: 6 would"))
      << sentence(c);
  EXPECT_TRUE(compared(routes(6, 6), {.baseline = "raw"}).is_best);
}

TEST(Groups, WithOneFailedRunEachCountAsTheirMedian) {
  std::vector<Record> records;
  for (int group = 0; group < 8; ++group) {
    for (int run = 0; run < 20; ++run) {
      const std::string sequence = std::to_string(group) + " " + std::to_string(run);
      records.push_back(score(sequence, 0, "raw", 1.0 + 0.1 * run));
      records.back().cell.edit().group = std::to_string(group);
      records.push_back(run == group ? failed(sequence, 0, "dual")
                                     : score(sequence, 0, "dual", 0.5 + 0.05 * run));
      records.back().cell.edit().group = std::to_string(group);
    }
  }
  const Comparison c = compared(records, {.baseline = "raw"});
  EXPECT_EQ(sentence(c),
            "no method beats raw: dual is 50 % below raw (95 %: 50 to 50) on 152 of 160 runs; dual "
            "fails on 8 (significantly more often)");
  EXPECT_DOUBLE_EQ(c.methods[0].ratio->typical.estimate, 0.5);
}

TEST(Groups, AreSequencesWhereTheseAreAskedFor) {
  const Comparison c = compared(sweep(), {.baseline = "uniform", .over = Over::sequences});
  EXPECT_EQ(c.groups, 2u);
  EXPECT_EQ(c.methods[0].wins, 2u);
  EXPECT_EQ(unit_text(c), "2 sequences (8 runs)");
  // Sequences of one group are not independent either.
  EXPECT_EQ(compared(routes(6, 5), {.baseline = "raw", .over = Over::sequences}).groups, 6u);
}

TEST(Copies, OfTheSameDataAreOneObservation) {
  std::vector<Record> records;  // ten identical problems
  for (int i = 0; i < 10; ++i) {
    for (const char* method : {"raw", "dual"}) {
      records.push_back(score("room", i, method, method[0] == 'd' ? 0.9 : 1.0));
      records.back().cell.edit().content = "c0ffee";
    }
  }
  const Comparison c = compared(records, {.baseline = "raw"});
  EXPECT_EQ(c.groups, 1u);
  EXPECT_EQ(c.copies, 9u);
  EXPECT_FALSE(c.methods[0].p);
  EXPECT_TRUE(has_note(c, "9 runs repeat the data of another and are not counted"));
  for (Record& r : records) r.cell.edit().content = std::to_string(r.cell->repeat);
  EXPECT_EQ(compared(records, {.baseline = "raw"}).groups, 10u);
}

TEST(Remarks, RejectsStatisticsWithoutADirection) {
  for (const std::string value : {"count", "sse"}) {
    EXPECT_EQ(refusal_of([&] { compare(sweep(), {.baseline = "raw", .value = value}); }),
              "value: '" + value +
                  "' depends on the number of errors: no value is better than another; expected "
                  "rmse, mean, median, std, min, max, p90, p95, p99");
  }
}

TEST(Sequences, ThatDifferAreStatedAndTheirDifferencesNotInTheInterval) {
  const Comparison c = compared(one_of_four(), {.baseline = "raw"});
  const Interval& typical = c.methods[0].ratio->typical;
  EXPECT_NEAR(typical.estimate, std::exp(0.25 * std::log(0.8)), 0.004);
  EXPECT_LT(typical.high - typical.low, 0.015);
}

}  // namespace
}  // namespace loopbench::compared_sweep::compare_groups_test
