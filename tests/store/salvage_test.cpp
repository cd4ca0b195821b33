/// Salvage: every intact cell of a damaged store, whatever else is damaged.
#include "harness/store/salvage.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <random>
#include <sstream>

#include "harness/store/damage.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/tiny_store.hpp"

namespace loopbench::salvage_test {

using namespace methods;
using namespace harness;

namespace {

using namespace tiny_store;  // NOLINT: the fixture and its config

constexpr std::size_t kPage = 4096;

/// 2 sequences, 20 repeats, 4 methods: every table has several pages.
const std::string kMany = config(
    "straight, {method: shift, by: 1, label: shifted}, {method: shift, by: 2, label: more}, "
    "{method: shift, fail: true, label: fails}",
    "repeats: 20\n");

class Salvage : public TinyStore {
 protected:
  static std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void put(const std::string& bytes, const std::string& log = "") const {
    for (const char* tail : {"-wal", "-shm", "-journal"}) {
      std::filesystem::remove(file_.string() + tail);
    }
    std::ofstream(file_, std::ios::binary) << bytes;
    if (!log.empty()) std::ofstream(file_.string() + "-wal", std::ios::binary) << log;
  }

  /// Without the sizes of the sequences' traces, which salvage can lose.
  static std::string without_traces(const std::string& text) {
    std::istringstream in(text);
    std::string out;
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with("sequence ")) out += line + "\n";
    }
    return out;
  }

  /// Salvages into a new store and completes it; every cell must be as in `expected`.
  Salvaged salvaged(const std::string& config, const std::string& expected) {
    std::filesystem::remove(new_);
    const std::string before = bytes_of(file_);
    const Salvaged out = salvage_store(file_, new_);
    EXPECT_EQ(bytes_of(file_), before) << "the damaged store is only read";
    require_intact_store(new_);
    EXPECT_FALSE(std::filesystem::exists(new_.string() + ".partial"));
    std::filesystem::rename(new_, file_);
    for (const char* tail : {"-wal", "-shm"}) std::filesystem::remove(file_.string() + tail);
    const Ran completed = run(config);
    cells_run_again_ = completed.cells.size();
    EXPECT_TRUE(without_traces(store_text(file_)) == without_traces(expected));
    if (out.traces.empty()) {
      EXPECT_TRUE(store_text(file_) == expected);
    }
    return out;
  }

  std::filesystem::path new_ = folder_.path() / "new" / "results.sqlite";
  std::size_t cells_run_again_ = 0;
};

TEST_F(Salvage, KeepsEveryCellOfAnIntactStoreAlsoUnusedOnes) {
  run(config("straight, {method: shift, by: 3, label: shifted}"));
  run(kUsual);
  const Salvaged out = salvaged(kUsual, store_text(file_));
  EXPECT_EQ(out.cells, 6u) << "two of them belong to the earlier config";
  EXPECT_TRUE(out.lost.empty() && out.traces.empty() && !out.incomplete && !out.run_lost);
  EXPECT_EQ(out.nameless + out.unknown_origin, 0u);
  EXPECT_EQ(cells_run_again_, 0u);
}

TEST_F(Salvage, AnUnreadablePageCostsItsOwnCellsOnly) {
  run(kMany);
  const std::string intact = bytes_of(file_);
  const std::string expected = store_text(file_);
  const std::size_t pages = intact.size() / kPage;
  std::size_t lost = 0;
  std::mt19937_64 random(1);
  for (std::size_t page = 0; page < pages; page += 1 + random() % 15) {
    std::string bytes = intact;
    for (std::size_t i = 0; i < kPage; ++i) {
      bytes[page * kPage + i] = static_cast<char>(page % 2 == 0 ? 0 : random());
    }
    put(bytes);
    const Salvaged out = salvaged(kMany, expected);
    EXPECT_EQ(out.cells + cells_run_again_, 160u) << "page " << page;
    EXPECT_LE(cells_run_again_, 80u) << "page " << page;
    if (cells_run_again_ > 0) {
      EXPECT_TRUE(!out.lost.empty() || out.nameless > 0 || out.incomplete) << "page " << page;
    }
    lost += cells_run_again_;
  }
  EXPECT_GT(lost, 0u);
}

TEST_F(Salvage, NamesWhatIsLost) {
  run(kUsual);
  const std::string expected = store_text(file_);
  Database(file_, Database::Mode::read)
      .execute(
          "UPDATE scores SET numbers = zeroblob(length(numbers)) WHERE cell = (SELECT id FROM cell "
          "WHERE position = 3)");
  const Salvaged out = salvaged(kUsual, expected);
  EXPECT_EQ(out.cells, 3u);
  EXPECT_EQ(out.lost, Labels{"b / shifted"});
  EXPECT_EQ(cells_run_again_, 1u);
}

TEST_F(Salvage, NeedsNeitherTheFirstPageNorTheEndOfTheFile) {
  run(kMany);
  const std::string intact = bytes_of(file_);
  const std::string expected = store_text(file_);
  put(std::string(kPage, '\0') + intact.substr(kPage));  // header, schema and roots
  EXPECT_EQ(salvaged(kMany, expected).cells, 160u);
  std::size_t before = 160;
  for (const double share : {0.9, 0.5, 0.3}) {
    put(intact.substr(0, static_cast<std::size_t>(share * static_cast<double>(intact.size()))));
    std::filesystem::remove(new_);
    const std::string message = refusal_of([&] {
      const Salvaged out = salvaged(kMany, expected);
      EXPECT_LT(out.cells, before + 1);
      before = out.cells;
    });
    if (!message.empty()) {
      EXPECT_NE(message.find("no intact cell found"), std::string::npos);
    }
  }
}

TEST_F(Salvage, MissingTablesCostWhatTheyContained) {
  run(kMany);
  const std::string intact = bytes_of(file_);
  const std::string expected = store_text(file_);
  for (const auto& [sql, most] :
       std::map<std::string, std::size_t>{{"DROP TABLE phase", 160},
                                          {"DROP TABLE count", 80},
                                          {"DROP TABLE note", 0},
                                          {"DROP TABLE section", 80},
                                          {"DROP TABLE trace", 120},
                                          {"DROP TABLE digest", 0},
                                          {"DROP TABLE run", 0},
                                          {"DROP TABLE provenance", 0},
                                          {"DROP TABLE sequence_trace", 0},
                                          {"DROP INDEX cell_position; DROP INDEX phase_cell", 0}}) {
    put(intact);
    Database(file_, Database::Mode::read).execute(sql);
    const Salvaged out = salvaged(kMany, expected);
    EXPECT_LE(cells_run_again_, most) << sql;
    EXPECT_EQ(out.run_lost, sql == "DROP TABLE run" || sql == "DROP TABLE digest");
    EXPECT_EQ(out.unknown_origin, sql == "DROP TABLE provenance" ? 160u : 0u);
    EXPECT_EQ(out.traces.size(), sql == "DROP TABLE sequence_trace" ? 40u : 0u);
    EXPECT_EQ(out.without_phases, sql == "DROP TABLE phase" ? 120u : 0u);
  }
  put(intact);
  Database(file_, Database::Mode::read).execute("DROP TABLE cell");
  EXPECT_NE(refusal_of([&] { salvage_store(file_, new_); }).find("no intact cell found"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(new_));
}

TEST_F(Salvage, ATruncatedOrDamagedLogCostsItsOwnCellsOnly) {
  run(kUsual);
  const std::string first = bytes_of(file_);
  const pid_t child = fork();
  if (child == 0) {  // a sweep that is killed leaves its cells in the log
    const Sweep sweep = parse_sweep(kMany, folder_.path() / "c.yaml", known_);
    CellKeys keys(sweep, known_, root_, build_);
    Store store(file_, keys, {{"commit", commit_}});
    const std::vector<Cell> all = cells(sweep, seeded(sweep, known_), "");
    const Resumed resumed = store.resume(all, all, Retry::none);
    Sequences sequences(sweep, known_, root_, resumed.missing);
    const StopRequests stop = 0;
    run_sweep(sweep, resumed.missing, known_, sequences, 1, stop, [&](const CellResult& r) {
      store.write(r);
      if (r.cell.index == 60) raise(SIGKILL);
    });
    _exit(1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  const std::string bytes = bytes_of(file_);
  const std::string log = bytes_of(file_.string() + "-wal");
  ASSERT_GT(log.size(), 100 * kPage);
  std::size_t all = 0;
  std::string expected;
  {
    run(kMany);
    expected = store_text(file_);
    put(bytes, log);
    all = salvaged(kMany, expected).cells;
    EXPECT_GE(all, 61u);
  }
  std::mt19937_64 random(3);
  const std::size_t frame = 24 + kPage;
  for (int i = 0; i < 3; ++i) {
    const std::size_t size = 32 + random() % (log.size() - 32);
    put(bytes, log.substr(0, size));
    EXPECT_LE(salvaged(kMany, expected).cells, all);

    std::string changed = log;
    const std::size_t at = 32 + frame * (random() % (log.size() / frame)) + 24 + random() % kPage;
    changed[std::min(at, log.size() - 1)] ^= 1;
    put(bytes, changed);
    EXPECT_GE(salvaged(kMany, expected).cells + 8, all) << "cells behind the damage are kept";
  }
  put(bytes, "no log" + log.substr(6));
  EXPECT_EQ(salvaged(kMany, expected).cells, all) << "a damaged header of the log";
}

TEST_F(Salvage, RowsOfAnUnfinishedCellAreNotGivenToTheNextOne) {
  run(kMany);
  const std::string expected = store_text(file_);
  std::filesystem::remove(file_);
  run(kUsual);
  Database(file_, Database::Mode::read)
      .execute(
          "INSERT INTO scores SELECT max(cell) + 1, list, numbers, statuses FROM scores;"
          "INSERT INTO phase SELECT max(id) + 1, 'unfinished', 1.0 FROM cell;"
          "INSERT INTO count SELECT max(id) + 1, 'unfinished', 1.0 FROM cell;"
          "INSERT INTO note SELECT max(id) + 1, 'unfinished' FROM cell");
  const Salvaged out = salvaged(kMany, expected);
  EXPECT_EQ(out.cells, 4u);
  EXPECT_EQ(out.nameless, 1u);
}

TEST_F(Salvage, SequencesMissingInTheLogAreTakenFromTheFile) {
  run(kUsual);
  const std::string expected = store_text(file_);
  std::string bytes;
  std::string log;
  {
    Database database(file_, Database::Mode::read);
    database.execute(
        "PRAGMA journal_mode = WAL; PRAGMA wal_autocheckpoint = 0; DELETE FROM sequence");
    bytes = bytes_of(file_);
    log = bytes_of(file_.string() + "-wal");
  }
  put(bytes, log);
  EXPECT_EQ(salvaged(kUsual, expected).cells, 4u);
  EXPECT_EQ(cells_run_again_, 0u);
}

TEST_F(Salvage, RejectsOtherFilesAndKeepsExistingStores) {
  run(kUsual);
  const std::filesystem::path text = folder_.file("text.sqlite", "no store\n");
  EXPECT_NE(refusal_of([&] { salvage_store(text, new_); }).find("text.sqlite: no intact cell"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(new_));
  EXPECT_NE(refusal_of([&] { salvage_store(file_, text); }).find("already exists"),
            std::string::npos);
  EXPECT_EQ(bytes_of(text), "no store\n");
  EXPECT_NE(refusal_of([&] { salvage_store("/none.sqlite", new_); }).find("file not found"),
            std::string::npos);
}

TEST_F(Salvage, RandomDamageNeverYieldsAnotherNumber) {
  run(kMany);
  const std::string intact = bytes_of(file_);
  const std::string expected = store_text(file_);
  std::mt19937_64 random(4);
  std::size_t kept = 0;
  for (int i = 0; i < 3; ++i) {
    std::string bytes = intact;
    for (int k = 0; k < 30; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
    put(bytes);
    kept += salvaged(kMany, expected).cells;
  }
  EXPECT_GT(kept, 100u) << "of 480";
}

}  // namespace
}  // namespace loopbench::salvage_test
