/// Division of sweeps into shards, and their stores.
#include "harness/sweep/store/shard.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "harness/sweep/store/match_cells.hpp"
#include "harness/sweep/store/merge.hpp"
#include "tests/support/tiny_store.hpp"

namespace loopbench::tiny_store::shard_test {

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

TEST(Shards, TextsAreRead) {
  EXPECT_EQ(parse_shard("3/8").number, 3u);
  EXPECT_EQ(parse_shard("3/8").count, 8u);
  EXPECT_EQ(parse_shard("8/8").folder(), "8-of-8");
  for (const char* text :
       {"", "3", "0/8", "9/8", "3/0", "-1/8", "3/8x", "3 /8", "a/b", "1/9999999"})
    EXPECT_THROW(parse_shard(text), InputError) << text;
}

TEST(Shards, SequencesStayTogetherAndEveryCellIsInOneShard) {
  const std::vector<Cell> cells = grid(5, 7, 3);  // 15 sequences
  for (const std::size_t count : {1u, 2u, 8u, 15u, 16u, 200u}) {
    std::map<std::size_t, std::size_t> shard_of;  // by index of the cell
    std::size_t largest = 0;
    for (std::size_t i = 1; i <= count; ++i) {
      const std::vector<Cell> own = cells_of({i, count}, cells);
      largest = std::max(largest, own.size());
      EXPECT_TRUE(std::ranges::is_sorted(own, {}, &Cell::index));
      for (const Cell& cell : own) EXPECT_TRUE(shard_of.emplace(cell.index, i).second);
    }
    EXPECT_EQ(shard_of.size(), cells.size());
    const bool is_split = count > 15;
    EXPECT_EQ(largest, is_split ? (105 + count - 1) / count : (15 + count - 1) / count * 7);
    for (std::size_t i = 0; i + 1 < cells.size() && !is_split; ++i) {
      if (cells[i].dataset == cells[i + 1].dataset && cells[i].repeat == cells[i + 1].repeat) {
        EXPECT_EQ(shard_of[i], shard_of[i + 1]);
      }
    }
  }
  EXPECT_TRUE(cells_of({2, 3}, {}).empty());
}

TEST_F(ShardTest, MergeCountsWhatIsMissingAndRunCompletesIt) {
  run(kUsual);
  const std::string complete = store_text(file_);
  file_ = folder_.path() / "1.sqlite";
  run(kUsual, Retry::none, "a / straight|b / ");
  const std::filesystem::path out = folder_.path() / "out" / "results.sqlite";
  const Merged merged = merge_stores({file_}, out);
  EXPECT_EQ(merged.planned, 4u);
  EXPECT_EQ(merged.missing, 1u);
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

}  // namespace
}  // namespace loopbench::tiny_store::shard_test
