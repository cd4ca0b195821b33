/// Cost tables, computed by hand.
#include "harness/profile/profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "harness/program/counted_malloc.hpp"

namespace loopbench::profile_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

TEST(PowerLaw, FindsAnExactExponent) {
  const auto law = power_law({1, 2, 4, 8}, {3, 12, 48, 192});  // 3 x^2
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->exponent, 2.0, 1e-12);
  EXPECT_NEAR(law->error, 0.0, 1e-7);
  EXPECT_NEAR(law->r2, 1.0, 1e-12);
}

TEST(PowerLaw, TellsHowSureItIs) {
  // In units of log 2: x = 0 1 2, y = 0 2 1. Slope 1/2, left (1/2)^2 + 1 + (1/2)^2 = 3/2 of 2;
  // error sqrt(3/2 / 1 / 2).
  const auto law = power_law({1, 2, 4}, {1, 4, 2});
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->exponent, 0.5, 1e-12);
  EXPECT_NEAR(law->error, std::sqrt(0.75), 1e-12);
  EXPECT_NEAR(law->r2, 0.25, 1e-12);
}

TEST(PowerLaw, NeedsThreePointsAndALever) {
  EXPECT_FALSE(power_law({1, 10}, {1, 10}));
  EXPECT_FALSE(power_law({1, 2, 3}, {1, 2, 3}));
  EXPECT_FALSE(power_law({1, 2, 4}, {0, 2, 3}));
}

TEST(ParetoFront, KeepsWhatNothingBeatsInBoth) {
  EXPECT_EQ(pareto_front({1, 2, 3, 2, 4}, {4, 2, 3, 3, 1}),
            (std::vector<bool>{true, true, false, false, true}));
  EXPECT_EQ(pareto_front({1, 1, 1}, {2, 2, 3}), (std::vector<bool>{true, true, false}))
      << "equals do not beat each other";
  EXPECT_EQ(pareto_front({1, 2}, {1, 1}), (std::vector<bool>{true, false}));
}

CellRecord cell(std::int64_t position,
                const std::string& sequence,
                const std::string& method,
                std::int64_t keyframes,
                double seconds) {
  CellRecord out;
  out.position = position;
  out.sequence = sequence;
  out.method = method;
  out.keyframes = keyframes;
  out.runs = 1;
  out.seconds = seconds;
  out.status = Status::ok;
  out.worker = "isolated";
  return out;
}

Record score(std::int64_t position, const std::string& times, double rmse) {
  Record out;
  out.cell = position;
  out.protocol = "p";
  out.times = times;
  out.metric = "ate";
  out.relation = "translation";
  out.axis = "3d";
  out.unit = "m";
  out.statistics.rmse = rmse;
  return out;
}

TEST(Scaling, OnePointPerSize) {
  const std::vector<CellRecord> cells{cell(0, "s", "m", 100, 0.001),
                                      cell(1, "s", "m", 100, 0.003),
                                      cell(2, "t", "m", 200, 0.004),
                                      cell(3, "u", "m", 400, 0.008),
                                      cell(4, "u", "once", 400, 0.008)};
  const TableView listing = scaling(cells);
  ASSERT_EQ(listing.lines.size(), 1u);
  EXPECT_EQ(listing.lines[0],
            (std::vector<TableViewEntry>{"m", "3", "100 to 400", "1.00", "0.00", "1.000", "8"}));
}

TEST(Pareto, OverSequencesThatAllHave) {
  const std::vector<CellRecord> cells{cell(0, "s", "slow", 9, 0.004),
                                      cell(1, "t", "slow", 9, 0.001),
                                      cell(2, "s", "fast", 9, 0.001),
                                      cell(3, "t", "fast", 9, 0.001),
                                      cell(4, "s", "worse", 9, 0.002),
                                      cell(5, "t", "worse", 9, 0.008),
                                      cell(6, "s", "part", 9, 0.0005)};
  std::vector<Record> records;
  const double errors[] = {1, 4, 4, 9, 4, 9, 0.1};  // geometric means 2, 6, 6
  for (int i = 0; i < 7; ++i) {
    records.push_back(score(i, "keyframes", 77));
    records.push_back(score(i, "dense", errors[i]));
  }
  const TableView listing = pareto(cells, records, {});
  using Row = std::vector<TableViewEntry>;
  ASSERT_EQ(listing.lines.size(), 4u);
  EXPECT_EQ(listing.lines[0], (Row{"part", "1 of 2", "0.1", "0.5", "-"}));
  EXPECT_EQ(listing.lines[1], (Row{"fast", "2 of 2", "6", "1", "yes"}));
  EXPECT_EQ(listing.lines[2], (Row{"slow", "2 of 2", "2", "2", "yes"}));
  EXPECT_EQ(listing.lines[3], (Row{"worse", "2 of 2", "6", "4", "no"}));
}

TEST(ParetoFront, TakesTinyDifferencesForNone) {
  // Two methods with equal results up to rounding: only the faster one is on the front.
  EXPECT_EQ(pareto_front({1.0, 1.0 - 1e-7}, {1.0, 15.0}), (std::vector<bool>{true, false}));
  EXPECT_EQ(pareto_front({1.0, 1.0 - 1e-5}, {1.0, 15.0}), (std::vector<bool>{true, true}));
}

TEST(Pareto, LeavesOutOraclesAndMethodsThatLackARun) {
  std::vector<CellRecord> cells{cell(0, "s", "fast", 9, 0.001),
                                cell(1, "s", "fast", 9, 0.001),
                                cell(2, "s", "leaky", 9, 0.0001),
                                cell(3, "s", "leaky", 9, 0.0001),
                                cell(4, "s", "lucky", 9, 0.0001),
                                cell(5, "s", "lucky", 9, 0.0001)};
  std::vector<Record> records;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells[i].repeat = static_cast<std::int64_t>(i % 2);
    cells[i].oracle = cells[i].method == "leaky";
    cells[i].oracle_closures = true;
    if (i != 5) records.push_back(score(cells[i].position, "dense", i < 2 ? 1.0 : 0.5));
  }
  cells[5].status = Status::failed;
  const TableView listing = pareto(cells, records, {});
  using Row = std::vector<TableViewEntry>;
  ASSERT_EQ(listing.lines.size(), 3u);
  EXPECT_EQ(listing.lines[0], (Row{"leaky (oracle)", "2 of 2", "0.5", "0.1", "-"}));
  EXPECT_EQ(listing.lines[1], (Row{"lucky", "1 of 2", "0.5", "0.1", "-"}));
  EXPECT_EQ(listing.lines[2], (Row{"fast", "2 of 2", "1", "1", "yes"}));
  const auto has = [&](const TableView& of, const std::string& note) {
    return std::ranges::any_of(of.notes, [&](const std::string& n) { return n.starts_with(note); });
  };
  for (const TableView& of : {listing, costs(cells), reported(cells), scaling(cells)}) {
    EXPECT_TRUE(has(of, "oracle: the method or its data uses the reference")) << of.title;
    EXPECT_TRUE(has(of, "closures are oracle (measured in the reference or selected by it): s"))
        << of.title;
  }
  EXPECT_EQ(costs(cells).lines[1][0].text, "leaky (oracle)");
}

TEST(Pareto, HasNoMeanWhereAnErrorIsZero) {
  const std::vector<CellRecord> cells{cell(0, "s", "perfect once", 9, 0.001),
                                      cell(1, "t", "perfect once", 9, 0.001),
                                      cell(2, "s", "other", 9, 0.002),
                                      cell(3, "t", "other", 9, 0.002)};
  const std::vector<Record> records{score(0, "dense", 3e-16),
                                    score(1, "dense", 9.0),
                                    score(2, "dense", 1.0),
                                    score(3, "dense", 4.0)};
  const TableView listing = pareto(cells, records, {});
  using Row = std::vector<TableViewEntry>;
  ASSERT_EQ(listing.lines.size(), 2u);
  EXPECT_EQ(listing.lines[0], (Row{"perfect once", "2 of 2", "-", "1", "-"}));
  EXPECT_EQ(listing.lines[1], (Row{"other", "2 of 2", "2", "2", "yes"}));
  EXPECT_EQ(std::ranges::count(listing.notes, "no mean where an error is zero: perfect once"), 1);
}

TEST(TableView, ReadsAsMarkdownAndAsCsv) {
  const TableView listing{"t", {"a", "b"}, {{"x|y", "1"}}, {"note"}};
  EXPECT_EQ(markdown(listing),
            "### t\n\n| a    |   b |\n| ---- | --: |\n| x\\|y |   1 |\n\n- note\n");
  EXPECT_EQ(csv(listing), "table,a,b\nt,x|y,1\n");
}

TEST(Allocations, CountCallsOfEveryKindOnEveryThread) {
  EXPECT_EQ(allocations(), std::nullopt) << "a library does not replace malloc";
  if (counted_malloc() == nullptr) GTEST_SKIP() << "not counted under sanitizers";
  set_allocation_counter(counted_malloc());
  const std::optional<std::int64_t> before = allocations();
  // Volatile, because the compiler would remove the unused allocation.
  void* volatile block = std::malloc(10);
  block = std::realloc(block, 1000);
  std::free(block);
  block = std::calloc(3, 5);
  std::free(block);
  block = std::aligned_alloc(64, 128);
  std::free(block);
  void* aligned = nullptr;
  ASSERT_EQ(posix_memalign(&aligned, 32, 32), 0);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(aligned) % 32, 0u);
  std::free(aligned);
  EXPECT_EQ(posix_memalign(&aligned, 3, 32), EINVAL);
  int* volatile one = new int(7);
  delete one;
  EXPECT_EQ(*allocations() - *before, 6);
  std::int64_t inside = 0;
  std::thread([&] {
    const std::int64_t begun = *allocations();
    for (int i = 0; i < 1000; ++i) {
      int* volatile more = new int(i);
      delete more;
    }
    inside = *allocations() - begun;
  }).join();
  EXPECT_EQ(inside, 1000);
  set_allocation_counter(nullptr);
}

}  // namespace
}  // namespace loopbench::profile_test
