/// Stores that are large enough to be read through two connections.
#include "harness/store/cell_rows.hpp"
#include "harness/store/damage.hpp"
#include "harness/store/open.hpp"
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
    const std::string numbers =
        "WITH RECURSIVE copy(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM copy WHERE n < 2499) ";
    database.execute(
        numbers +
        "INSERT INTO score_value SELECT cell + 4 * n, number, definition, count, rmse, "
        "mean, median, std, min, max, sse, pairs, possible, span, status, why FROM "
        "copy, score_value WHERE cell <= 4");
    const std::string columns = std::string(kCellColumns).substr(sizeof "position,");
    database.execute(numbers + "INSERT INTO cell (id, position, " + columns +
                     ") SELECT id + 4 * n, position + 4 * n, " + columns +
                     " FROM copy, cell WHERE id <= 4");
    ChecksumWriter checksums(database);
    for (std::int64_t id = 5; id <= kCells; ++id) checksums.write(id);
    database.execute("UPDATE run SET value = 10000 WHERE key = 'cells'");
    transaction.commit();
  }

  void change(const std::string& sql) { Database(file_, Database::Mode::read).execute(sql); }

  std::string refusal() {
    return refusal_of([&] { require_intact_store(file_); });
  }

  static constexpr std::int64_t kCells = 10'000;
};

TEST_F(ManyCells, AreReadInOrder) {
  Database database = open_store(file_);
  const std::vector<StoredCell> cells = checked_cells(database, false);
  ASSERT_EQ(cells.size(), static_cast<std::size_t>(kCells));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    ASSERT_EQ(cells[i].id, static_cast<std::int64_t>(i + 1));
    ASSERT_TRUE(cells[i].intact);
    ASSERT_EQ(cells[i].score_count, cells[i % 4].score_count);
  }
  EXPECT_EQ(refusal(), "");
}

TEST_F(ManyCells, DamageIsNoticedInBothHalves) {
  const std::filesystem::path sound = folder_.path() / "sound.sqlite";
  std::filesystem::copy_file(file_, sound);
  for (const std::string cell : {"17", "9983"}) {
    for (const std::string& damage : {"UPDATE score_value SET rmse = rmse + 1 WHERE cell = " + cell,
                                      "DELETE FROM score_value WHERE cell = " + cell,
                                      "UPDATE cell SET seconds_median = 7 WHERE id = " + cell}) {
      std::filesystem::copy_file(sound, file_, std::filesystem::copy_options::overwrite_existing);
      change(damage);
      EXPECT_NE(refusal().find("is damaged"), std::string::npos) << damage;
      Database database(file_, Database::Mode::read);
      EXPECT_EQ(std::ranges::count(checked_cells(database, false), false, &StoredCell::intact), 1)
          << damage;
    }
  }
}

TEST_F(ManyCells, TheSecondConnectionMaySeeALaterState) {
  change("PRAGMA journal_mode = WAL");
  Database reader = open_store(file_);
  std::vector<StoredCell> before = read_cell_rows(reader);  // its state from here on
  {
    Database writer(file_, Database::Mode::read);
    Transaction transaction(writer);
    writer.execute("UPDATE score_value SET rmse = 7 WHERE cell = 9983");
    ChecksumWriter(writer).write(9983);
    transaction.commit();
  }
  check_scores(reader, before);
  require_intact(reader, before);
  Database now = open_store(file_);
  std::vector<StoredCell> after = read_cell_rows(now);
  check_scores(now, after);
  require_intact(now, after);
  EXPECT_NE(after[9982].checksum, before[9982].checksum);
}

}  // namespace
}  // namespace loopbench::many_cells_test
