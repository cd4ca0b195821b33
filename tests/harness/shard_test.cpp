/// Division of sweeps into shards, and their stores.
#include "harness/shards/shard.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "harness/shards/costs.hpp"
#include "harness/store/merge.hpp"
#include "harness/store/plan.hpp"
#include "harness/store/resume.hpp"
#include "tests/support/tiny_store.hpp"

namespace loopbench::shard_test {

using namespace harness;
using namespace tiny_store;  // NOLINT: the fixture and its config
using ShardTest = TinyStore;

namespace {

std::vector<Cell> grid(std::size_t datasets, std::size_t methods, int repeats) {
  std::vector<Cell> out;
  for (std::size_t d = 0; d < datasets; ++d) {
    for (int r = 0; r < repeats; ++r) {
      for (std::size_t m = 0; m < methods; ++m) out.push_back({out.size(), d, m, r});
    }
  }
  return out;
}

std::map<std::size_t, double> loads(const std::vector<std::size_t>& shards,
                                    const CellCosts& costs) {
  std::map<std::size_t, double> out;
  for (std::size_t i = 0; i < shards.size(); ++i) out[shards[i]] += costs.cells[i];
  return out;
}

TEST(Shards, TextsAreRead) {
  EXPECT_EQ(parse_shard("3/8").number, 3u);
  EXPECT_EQ(parse_shard("3/8").count, 8u);
  EXPECT_EQ(parse_shard("8/8").folder(), "8-of-8");
  for (const char* text :
       {"", "3", "0/8", "9/8", "3/0", "-1/8", "3/8x", "3 /8", "a/b", "1/9999999"})
    EXPECT_THROW(parse_shard(text), InputError) << text;
}

TEST(Shards, SequencesStayTogetherAndLoadsAreBalanced) {
  const std::vector<Cell> cells = grid(40, 7, 3);
  CellCosts costs{std::vector<double>(cells.size()), 0.01};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    costs.cells[i] = 0.01 * static_cast<double>(1 + cells[i].method + cells[i].dataset % 5);
  }
  const std::vector<std::size_t> shards = divide(cells, costs, 8);
  EXPECT_EQ(shards, divide(cells, costs, 8)) << "depends on nothing else";
  std::map<std::pair<std::size_t, int>, std::set<std::size_t>> of_sequence;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    of_sequence[{cells[i].dataset, cells[i].repeat}].insert(shards[i]);
  }
  for (const auto& [sequence, own] : of_sequence) EXPECT_EQ(own.size(), 1u);
  double largest = 0.0;
  double all = 0.0;
  const auto by_shard = loads(shards, costs);
  ASSERT_EQ(by_shard.size(), 8u);
  for (const auto& [shard, load] : by_shard) {
    largest = std::max(largest, load);
    all += load;
  }
  EXPECT_LE(largest, 1.05 * all / 8.0);
}

TEST(Shards, ALongSequenceIsSplitIntoConsecutiveCells) {
  const std::vector<Cell> cells = grid(1, 100, 1);
  const CellCosts costs{std::vector<double>(cells.size(), 1.0), 0.1};
  const std::vector<std::size_t> shards = divide(cells, costs, 4);
  for (const auto& [shard, load] : loads(shards, costs)) EXPECT_EQ(load, 25.0);
  std::vector<std::size_t> changes = shards;
  changes.erase(std::unique(changes.begin(), changes.end()), changes.end());
  EXPECT_EQ(changes.size(), 4u);
}

TEST(Shards, EveryCellIsInOneShardEvenWithMoreShardsThanCells) {
  const std::vector<Cell> cells = grid(2, 2, 1);
  const CellCosts costs{std::vector<double>(cells.size(), 0.0), 0.0};
  for (const std::size_t count : {1u, 3u, 9u}) {
    const std::vector<std::size_t> shards = divide(cells, costs, count);
    std::size_t found = 0;
    for (std::size_t i = 1; i <= count; ++i) found += cells_of({i, count}, cells, shards).size();
    EXPECT_EQ(found, cells.size());
  }
  EXPECT_TRUE(divide({}, {}, 3).empty());
}

TEST_F(ShardTest, ThePlanNamesEveryPosition) {
  const std::string text =
      "datasets: [{dataset: line, seed: 1, label: a}, {dataset: line, seed: 2, label: b}]\n"
      "methods: [straight, {method: shift, sweep: {by: [1, 2, 3]}}]\nmetrics: [ate]\n"
      "repeats: 2\nexclude: [{dataset: a, method: 'shift .by=2.*'}]\n";
  const Sweep sweep = parse_sweep(text, folder_.path() / "c.yaml", known_);
  const std::vector<Cell> all = cells(sweep, seeded(sweep, known_), "");
  const SweepPlan plan(plan_text(sweep, all));
  ASSERT_EQ(plan.size(), static_cast<std::int64_t>(all.size()));
  for (const Cell& cell : all) {
    const std::string repeat = cell.repeat == 0 ? "" : " (repeat 1)";
    EXPECT_EQ(
        plan.label(static_cast<std::int64_t>(cell.index)),
        sweep.datasets[cell.dataset].label + repeat + " / " + sweep.methods[cell.method].label);
  }
  EXPECT_EQ(SweepPlan("").size(), 0);
  EXPECT_EQ(SweepPlan("dataset\tx\nmethod\ny\t\t").size(), 0);
}

TEST_F(ShardTest, MergeListsWhatIsMissingAndRunCompletesIt) {
  run(kUsual);
  const std::string complete = store_text(file_);
  file_ = folder_.path() / "1.sqlite";
  run(kUsual, Retry::none, "a / straight|b / ");
  const std::filesystem::path out = folder_.path() / "out" / "results.sqlite";
  const Merged merged = merge_stores({file_}, out);
  EXPECT_EQ(merged.planned, 4u);
  EXPECT_EQ(merged.missing, 1u);
  EXPECT_EQ(merged.first_missing, Labels{"a / shifted"});
  const Sweep sweep = parse_sweep(kUsual, folder_.path() / "c.yaml", known_);
  CellKeys keys(sweep, known_, root_, build_);
  const std::vector<Cell> all = cells(sweep, seeded(sweep, known_), "");
  const std::vector<Cell> missing = missing_cells(out, keys, all, all);
  ASSERT_EQ(missing.size(), 1u);
  EXPECT_EQ(missing[0].index, 1u);

  file_ = folder_.path() / "2.sqlite";
  run(kUsual, Retry::none, "a / shifted");
  EXPECT_THROW(merge_stores({file_}, out), InputError) << "exists";
  const Merged added = merge_stores({file_}, out, {.mixed_builds = false, .add = true});
  EXPECT_EQ(added.cells, 4u);
  EXPECT_EQ(added.missing, 0u);
  EXPECT_EQ(store_text(out), complete);
  EXPECT_EQ(merge_stores({file_}, out, {.mixed_builds = false, .add = true}).duplicates, 1u);
  EXPECT_EQ(store_text(out), complete) << "adding twice changes nothing";
}

TEST_F(ShardTest, MissingShardsAreNamed) {
  EXPECT_EQ(missing_shards("1/3 aa\n3/3 aa\n"), Labels{"2/3"});
  EXPECT_EQ(missing_shards("1/2 aa\n2/2 aa\n1/2 bb"), Labels{"2/2"});
  EXPECT_EQ(missing_shards("nonsense\n/\nx/y"), Labels{});
}

TEST_F(ShardTest, MeasuredCostsComeFromLabels) {
  run(kUsual);
  {
    Database database(file_, Database::Mode::read);
    database.execute("UPDATE cell SET runs = 2, cpu_seconds_median = id");
  }
  const Sweep sweep = parse_sweep(
      config("straight, {method: shift, by: 2, label: new}"), folder_.path() / "c.yaml", known_);
  const std::vector<Cell> all = cells(sweep, seeded(sweep, known_), "");
  const CellCosts costs = measured_costs(sweep, all, file_);
  // Ids 1 to 4 are a / straight, a / shifted, b / straight, b / shifted.
  const double overhead = costs.cells[0] - 2.0;
  EXPECT_GT(overhead, 0.0);
  EXPECT_NEAR(costs.cells[2] - overhead, 6.0, 1e-12);
  EXPECT_NEAR(costs.cells[1] - overhead, 5.0, 1e-12) << "the mean of all cells";
}

}  // namespace
}  // namespace loopbench::shard_test
