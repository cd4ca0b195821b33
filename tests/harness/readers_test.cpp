/// Stores that are read while others write.
#include <thread>

#include "harness/sweep/store/open.hpp"
#include "harness/sweep/store/stored_cells.hpp"
#include "tests/studies/synthetic_store.hpp"
#include "tests/support/command.hpp"
#include "tests/support/compared_sweep.hpp"
#include "tests/support/tiny_store.hpp"

namespace loopbench::tiny_store::readers_test {
namespace {

class Readers : public TinyStore {};

TEST_F(Readers, SeeOneStateWhileASweepWrites) {
  run(kUsual, Retry::none, "a / ");
  Database(file_, Database::Mode::read)
      .execute("PRAGMA journal_mode = WAL");  // as during a running sweep
  Database reader = open_store(file_);
  EXPECT_EQ(read_intact_cells(reader).size(), 2u);
  EXPECT_EQ(run(kUsual).cells.size(), 2u);
  require_intact(reader);
  EXPECT_EQ(read_intact_cells(reader).size(), 2u);
  EXPECT_EQ(read_cells(file_).size(), 4u);
}

/// Enough cells for several threads.
TEST_F(Readers, FindDamageInAnyPartOfALargeStore) {
  std::vector<Record> records;
  for (int i = 0; i < 2500; ++i) {
    Record& r = records.emplace_back(compared_sweep::ate("m" + std::to_string(i % 5), 1.0));
    r.cell.edit().position = i;
    r.cell.edit().sequence = "sequence " + std::to_string(i / 5);
  }
  synthetic::write_store(records, folder_.path());
  const std::filesystem::path file = folder_.path() / "results.sqlite";
  for (const char* const cell : {"1", "1251", "2500"}) {
    const std::string where = std::string(" WHERE cell = ") + cell;
    Database(file, Database::Mode::read).execute("PRAGMA journal_mode = WAL");
    Database before = open_store(file);
    before.integer("SELECT count(*) FROM cell");  // begins to read
    Database(file, Database::Mode::read).execute("UPDATE score_value SET rmse = 2" + where);
    EXPECT_EQ(read_intact_cells(before).size(), 2500u) << "written after it began to read";
    Database after = open_store(file);
    EXPECT_THROW(read_intact_cells(after), InputError) << cell;
    Database(file, Database::Mode::read).execute("UPDATE score_value SET rmse = 1" + where);
  }
  EXPECT_EQ(read_cells(file).size(), 2500u);

  // While a writer waits for a reader, no other connection can read.
  Database(file, Database::Mode::read).execute("PRAGMA journal_mode = DELETE");
  const auto is_readable = [&] {
    Database other(file, Database::Mode::read);
    other.execute("PRAGMA busy_timeout = 0");
    try {
      return other.integer("SELECT count(*) FROM cell") > 0;
    } catch (const InputError&) {
      return false;
    }
  };
  std::string error;
  {
    std::jthread writer;
    Database reader = open_store(file);
    writer = std::jthread([&] {
      try {
        Database(file, Database::Mode::read).execute("PRAGMA journal_mode = WAL");
      } catch (const InputError& caught) {
        error = caught.what();
      }
    });
    while (is_readable()) std::this_thread::yield();
    EXPECT_EQ(read_intact_cells(reader).size(), 2500u);
  }
  EXPECT_EQ(error, "");
}

}  // namespace
}  // namespace loopbench::tiny_store::readers_test
