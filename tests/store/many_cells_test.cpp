/// Stores that are large enough to be read through two connections.
#include "harness/store/cell_rows.hpp"
#include "harness/store/damage.hpp"
#include "harness/store/open.hpp"
#include "harness/store/write_digests.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/tiny_store.hpp"

namespace loopbench::many_cells_test {
namespace {

using namespace tiny_store;

class ManyCells : public TinyStore {
 protected:
  /// Copies the four cells of a sweep until the store is large, with their scores.
  ManyCells() {
    run(kUsual);
    Database database(file_, Database::Mode::read);
    Transaction transaction(database);
    const std::string columns =
        "key, build, sequence_key, provenance_key, sequence, repeat, method, "
        "dataset_options, method_options, closures, oracle_closures, "
        "oracle, worker, runs, seconds_median, seconds_min, seconds_max, "
        "cpu_seconds_median, peak_memory, added_memory, allocations, "
        "status, signal, why, failed_scores, score_digest";
    const std::string numbers =
        "WITH RECURSIVE copy(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM copy WHERE n < 2499) ";
    database.execute(numbers +
                     "INSERT INTO score_value SELECT cell + 4 * n, number, definition, count, "
                     "rmse, mean, median, std, min, max, sse, pairs, possible, span, status, why "
                     "FROM copy, score_value WHERE cell <= 4");
    database.execute(numbers + "INSERT INTO cell (id, position, " + columns +
                     ") SELECT id + 4 * n, position + 4 * n, " + columns +
                     " FROM copy, cell WHERE id <= 4");
    DigestWriter digests(database);
    for (std::int64_t id = 5; id <= kCells; ++id) digests.update_cell(id);
    update_sum(database, "cell");
    transaction.commit();
  }

  void change(const std::string& sql) { Database(file_, Database::Mode::read).execute(sql); }

  std::string refusal() {
    return refusal_of([&] { require_intact_store(file_); });
  }

  static constexpr std::int64_t kCells = 10'000;
  static_assert(kCells > kCellsWorthAThread);
};

TEST_F(ManyCells, AreReadInOrder) {
  Database database = open_store(file_);
  const CellRows rows = read_cell_rows(database, WithRecords::yes);
  EXPECT_TRUE(rows.complete);
  ASSERT_EQ(rows.cells.size(), static_cast<std::size_t>(kCells));
  ASSERT_EQ(rows.records.size(), rows.cells.size());
  for (std::size_t i = 0; i < rows.cells.size(); ++i) {
    ASSERT_EQ(rows.cells[i].id, static_cast<std::int64_t>(i + 1));
    ASSERT_TRUE(rows.cells[i].intact);
    ASSERT_EQ(rows.records[i].position, rows.cells[i].position);
    ASSERT_EQ(rows.records[i].method, rows.cells[i].method);
  }
  EXPECT_EQ(refusal(), "");
}

TEST_F(ManyCells, DamageIsNoticedInBothHalves) {
  const std::filesystem::path sound = folder_.path() / "sound.sqlite";
  std::filesystem::copy_file(file_, sound);
  for (const std::string cell : {"17", "9983"}) {
    for (const std::string& damage : {"UPDATE score_value SET rmse = 0 WHERE cell = " + cell,
                                      "DELETE FROM score_value WHERE cell = " + cell,
                                      "UPDATE cell SET seconds_median = 7 WHERE id = " + cell,
                                      "DELETE FROM cell WHERE id = " + cell}) {
      std::filesystem::copy_file(sound, file_, std::filesystem::copy_options::overwrite_existing);
      change(damage);
      EXPECT_NE(refusal().find("is damaged"), std::string::npos) << damage;
      Database database(file_, Database::Mode::read);
      const std::size_t left = damage.starts_with("DELETE FROM cell") ? 1 : 0;
      const CheckedStore found = check_rows(database, false);
      EXPECT_EQ(found.cells.cells.size(), static_cast<std::size_t>(kCells) - left) << damage;
      EXPECT_EQ(std::ranges::count(found.cells.cells, false, &CellRow::intact), left == 0 ? 1 : 0)
          << damage;
    }
  }
}

TEST_F(ManyCells, TheSecondConnectionMaySeeALaterState) {
  change("PRAGMA journal_mode = WAL");
  Database reader = open_store(file_);
  ASSERT_FALSE(written_digest(reader, "cell").empty());  // the state of the reader from here on
  {
    Database writer(file_, Database::Mode::read);
    Transaction transaction(writer);
    writer.execute("UPDATE cell SET seconds_median = 7 WHERE id = 9983");
    DigestWriter(writer).update_cell(9983);
    update_sum(writer, "cell");
    transaction.commit();
  }
  const CellRows before = read_cell_rows(reader);
  EXPECT_TRUE(before.complete);
  EXPECT_NE(before.cells[9982].seconds, 7.0);
  Database now = open_store(file_);
  const CellRows after = read_cell_rows(now);
  EXPECT_TRUE(after.complete);
  EXPECT_EQ(after.cells[9982].seconds, 7.0);
}

}  // namespace
}  // namespace loopbench::many_cells_test
