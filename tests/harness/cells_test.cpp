#include "harness/sweep/model/cells.hpp"

#include <gtest/gtest.h>

#include <climits>
#include <set>

#include "datasets/core/error.hpp"
#include "harness/sweep/text/hash.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::cells_test {

using namespace harness;

namespace {

Sweep two_by_three() {
  Sweep sweep;
  for (const char* name : {"room", "road"}) sweep.datasets.push_back({name, {}});
  for (const char* name : {"raw", "uniform", "uniform + dm"}) sweep.methods.push_back({name, {}});
  return sweep;
}

std::vector<std::string> names(const Sweep& sweep, const std::vector<Cell>& cells) {
  std::vector<std::string> out;
  for (const Cell& c : cells) {
    out.push_back(std::to_string(c.index) + " " + sweep.datasets[c.dataset].label + "/" +
                  sweep.methods[c.method].label + "#" + std::to_string(c.repeat));
  }
  return out;
}

TEST(Cells, AreNumberedDatasetRepeatMethod) {
  Sweep sweep = two_by_three();
  sweep.repeats = 2;
  EXPECT_EQ(names(sweep, cells(sweep, {true, false}, "")),
            (std::vector<std::string>{"0 room/raw#0",
                                      "1 room/uniform#0",
                                      "2 room/uniform + dm#0",
                                      "3 room/raw#1",
                                      "4 room/uniform#1",
                                      "5 room/uniform + dm#1",
                                      "6 road/raw#0",
                                      "7 road/uniform#0",
                                      "8 road/uniform + dm#0"}));
}

TEST(Cells, OnlyKeepsTheNumbersOfTheWholeSweep) {
  const Sweep sweep = two_by_three();
  EXPECT_EQ(names(sweep, cells(sweep, {true, true}, "road.*uni")),
            (std::vector<std::string>{"4 road/uniform#0", "5 road/uniform + dm#0"}));
  EXPECT_THROW(cells(sweep, {true, true}, "("), InputError);
}

TEST(Cells, ExclusionsMatchWholeLabels) {
  Sweep sweep = two_by_three();
  sweep.exclude.push_back({"road", "uniform"});
  EXPECT_EQ(names(sweep, cells(sweep, {false, false}, "road")),
            (std::vector<std::string>{"3 road/raw#0", "4 road/uniform + dm#0"}));
}

TEST(Cells, AreCountedWithoutOverflowBeforeTheyAreBuilt) {
  Sweep sweep = two_by_three();
  EXPECT_EQ(count_cells(sweep, {true, false}), 6u);
  sweep.repeats = 1'000'000;
  EXPECT_EQ(count_cells(sweep, {true, false}), 3'000'003u);
  sweep.repeats = INT_MAX;
  sweep.datasets.resize(100'000);
  sweep.methods.resize(100'000);
  EXPECT_EQ(count_cells(sweep, std::vector<bool>(100'000, true)), SIZE_MAX);
}

TEST(Cells, MoreThanTheLimitAreRejectedWithTheWayToRaiseIt) {
  Sweep sweep = two_by_three();
  sweep.config = "c.yaml";
  sweep.repeats = 400'000;
  EXPECT_EQ(refusal_of<InputError>([&] {
              cells(sweep, {true, false}, "road");
            }),
            "c.yaml: 2 datasets, 3 methods and 400000 repeats of seeded datasets give 1200003 "
            "cells, expected at most 1000000; 'limits: {cells: N}' accepts more");
  sweep.limits.cells = 1'200'003;
  EXPECT_EQ(cells(sweep, {true, false}, "road").size(), 3u);
}

TEST(Cells, DerivedSeedsDifferAndKeepTheFirst) {
  EXPECT_EQ(derived_seed(7, 0), 7);
  std::set<std::int64_t> seen;
  for (std::int64_t seed = 0; seed < 20; ++seed) {
    for (int repeat = 1; repeat < 50; ++repeat) {
      const std::int64_t derived = derived_seed(seed, repeat);
      EXPECT_GE(derived, 0);
      EXPECT_TRUE(seen.insert(derived).second);
    }
  }
}

TEST(Hash, IsThatOfXxhsum) {
  EXPECT_EQ(hex(hash_of("")), "99aa06d3014798d86001c324468d497f");  // xxhsum -H2 /dev/null
}

TEST(Hash, FieldsDoNotRunTogether) {
  EXPECT_NE(Fields().add("ab").add("c").hashed(), Fields().add("a").add("bc").hashed());
  EXPECT_NE(Fields().add("").hashed(), Fields().hashed());
}

}  // namespace
}  // namespace loopbench::cells_test
