/// Every call of the store to the disk fails in turn: the right result or a clear error, and every
/// cell that was reported as done is kept. LOOPBENCH_LONG=1: without gaps, and also with disks that
/// fail for good.
#include <sqlite3.h>

#include <cstdlib>
#include <set>
#include <utility>

#include "harness/store/merge.hpp"
#include "tests/store/fault_vfs.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/tiny_store.hpp"

namespace loopbench::faults_test {

using namespace methods;
using namespace harness;

namespace {

using namespace tiny_store;  // NOLINT: the fixture and its config

const bool kLong = std::getenv("LOOPBENCH_LONG") != nullptr;

const std::string kOther = config("{method: shift, by: 3, label: shifted}, straight");

class Faults : public TinyStore {
 protected:
  /// Runs the config; notes in `done_` what was reported as done before an error.
  void sweep(const std::string& text, Retry retry = Retry::none, bool fresh = false) {
    const Sweep sweep = parse_sweep(text, folder_.path() / "c.yaml", known_);
    CellKeys keys(sweep, known_, root_, build_);
    const std::vector<Cell> all = cells(sweep, seeded(sweep, known_), "");
    Store store(file_, keys, {{"commit", commit_}}, fresh);
    const Resumed resumed = store.resume(all, all, retry);
    run_here(sweep, resumed.missing, known_, root_, [&](const CellResult& r) {
      store.write(r);
      done_.insert(sweep.datasets[r.cell.dataset].label + " / " +
                   sweep.methods[r.cell.method].label);
    });
    store.close();
  }

  std::string names_in(const std::filesystem::path& folder) const {
    std::string out;
    for (const auto& file : std::filesystem::directory_iterator(folder)) {
      out += file.path().filename().string() + " ";
    }
    return out;
  }

  void restore() const {
    std::filesystem::remove_all(out_);
    std::filesystem::create_directories(out_);
    if (!before_.empty()) std::ofstream(file_, std::ios::binary) << before_;
  }

  static std::string bytes_of_file(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  /// Calls `act` on the same folder again and again, with another call failing each time, and
  /// `check(whether act returned)` after it.
  template <class Act, class Check>
  void in_turn(FaultVfs& source, long stride, Act act, Check check) {
    int errors = 0;
    for (const bool lasting : {false, true}) {
      if (lasting && !kLong) break;  // SQLite waits up to 10 s for some of them
      for (long number = 1;; number += kLong ? 1 : stride) {
        restore();
        done_.clear();
        source.fail(number, lasting);
        bool returned = false;
        try {
          act();
          returned = true;
        } catch (const InputError& error) {
          ++errors;
          const std::string message = error.what();
          EXPECT_NE(message.find(".sqlite"), std::string::npos) << message;
        }
        const bool failed = source.stop();
        const std::string where = "call " + std::to_string(number) + (lasting ? " and later" : "");
        SCOPED_TRACE(where);
        EXPECT_TRUE(returned || failed);
        check(returned);
        if (HasFailure() || !failed) break;
      }
    }
    EXPECT_GT(errors, 0);
    RecordProperty("errors", errors);
  }

  /// The store has every cell that was reported as done, and goes on to the undisturbed result.
  void expect_kept(const std::string& text, const std::string& expected) {
    const Ran again = run(text);
    for (const std::string& cell : again.cells) {
      EXPECT_FALSE(done_.contains(cell)) << cell << " was reported as done";
    }
    EXPECT_TRUE(again.resumed.damaged.empty());
    EXPECT_TRUE(store_text(file_) == expected);
  }

  /// Sets the text of the store that `act` makes of `before_`.
  template <class Act>
  std::string undisturbed(Act act) {
    restore();
    act();
    return store_text(file_);
  }

  std::filesystem::path out_ = folder_.path() / "out";
  std::string before_;  ///< bytes of the store at the start; empty: none
  std::set<std::string> done_;

  void SetUp() override { file_ = out_ / "results.sqlite"; }
};

TEST_F(Faults, ADiskThatFailsOnceLosesNoCellOfANewStore) {
  FaultVfs disk;
  const std::string expected = undisturbed([&] { sweep(kUsual); });
  in_turn(
      disk, 3, [&] { sweep(kUsual); }, [&](bool) { expect_kept(kUsual, expected); });
}

TEST_F(Faults, ADiskThatFailsOnceLosesNoCellOfAResumedStore) {
  FaultVfs disk;
  restore();
  sweep(kOther);
  before_ = bytes_of_file(file_);
  const std::string expected = undisturbed([&] { sweep(kUsual); });
  in_turn(
      disk, 5, [&] { sweep(kUsual); }, [&](bool) { expect_kept(kUsual, expected); });
  in_turn(
      disk, 7, [&] { sweep(kOther, Retry::all); }, [&](bool) { run(kOther), run(kUsual); });
}

TEST_F(Faults, ADiskThatFailsOnceLosesNoStoreThatFreshSetsAside) {
  FaultVfs disk;
  restore();
  sweep(kUsual);
  before_ = bytes_of_file(file_);
  const std::string expected = store_text(file_);
  in_turn(
      disk,
      7,
      [&] { sweep(kUsual, Retry::none, true); },
      [&](bool returned) {
        const std::filesystem::path previous = out_ / "previous-1.sqlite";
        const bool moved = std::filesystem::exists(previous);
        EXPECT_TRUE(moved || !returned);
        EXPECT_TRUE(store_text(moved ? previous : file_) == expected);
        expect_kept(kUsual, expected);
        EXPECT_EQ(names_in(out_).find("-wal"), std::string::npos) << names_in(out_);
      });
}

TEST_F(Faults, MergeOnADiskThatFailsOnceIsCompleteOrAbsent) {
  FaultVfs disk;
  restore();
  sweep(kUsual);
  before_ = bytes_of_file(file_);
  const std::string expected = store_text(file_);
  const std::filesystem::path target = out_ / "new.sqlite";
  const auto check = [&](bool returned) {
    EXPECT_EQ(std::filesystem::exists(target), returned);
    if (returned) {
      EXPECT_TRUE(store_text(target) == expected);
    }
    EXPECT_EQ(names_in(out_).find("partial"), std::string::npos) << names_in(out_);
    EXPECT_TRUE(store_text(file_) == expected);
  };
  in_turn(
      disk, 7, [&] { merge_stores({file_}, target); }, check);
}

TEST_F(Faults, ADiskThatDoesNotConfirmTheLastWriteIsAnError) {
  FaultVfs disk;
  restore();
  const Sweep plan = parse_sweep(kUsual, folder_.path() / "c.yaml", known_);
  CellKeys keys(plan, known_, root_, build_);
  const std::vector<Cell> all = cells(plan, seeded(plan, known_), "");
  Store store(file_, keys, {{"commit", commit_}});
  store.resume(all, all, Retry::none);
  run_here(plan, all, known_, root_, [&](const CellResult& r) { store.write(r); });
  disk.fail_all(SQLITE_IOERR_FSYNC);
  EXPECT_THROW(store.close(), InputError);
  disk.stop();
}

TEST_F(Faults, AReaderOnADiskThatFailsOnceReadsTheRightRowsOrNone) {
  restore();
  sweep(kUsual);
  before_ = bytes_of_file(file_);
  const std::string expected = store_text(file_);
  std::string text;
  const auto read = [&] { text = store_text(file_); };
  const auto check = [&](bool returned) {
    if (returned) {
      EXPECT_TRUE(text == expected);
    }
  };
  FaultVfs disk;
  in_turn(disk, 3, read, check);
}

TEST_F(Faults, APowerCutLosesNoCellThatWasSynced) {
  const int cuts = kLong ? 3000 : 60;
  std::mt19937_64 random(7);
  int tried = 0;
  std::size_t lost = 0;
  while (tried < cuts) {
    FaultVfs disk;
    restore();
    const std::filesystem::path cut = folder_.path() / "cut";
    std::set<std::string> synced;
    const Sweep plan = parse_sweep(kUsual, folder_.path() / "c.yaml", known_);
    bool busy = false;
    const auto check = [&] {
      if (std::exchange(busy, true)) return;
      ++tried;
      disk.cut_power(out_, cut, random);
      file_ = cut / "results.sqlite";
      const Ran again = run(kUsual);
      lost += again.cells.size();
      for (const std::string& cell : again.cells) {
        EXPECT_FALSE(synced.contains(cell)) << cell << " was synced";
      }
      EXPECT_TRUE(again.resumed.damaged.empty());
      file_ = out_ / "results.sqlite";
      busy = false;
    };
    const unsigned every = 1 + static_cast<unsigned>(random() % 30);
    disk.before_each_change([&] {
      if (!busy && tried < cuts && random() % every == 0) check();
    });
    {
      CellKeys keys(plan, known_, root_, build_);
      const std::vector<Cell> all = cells(plan, seeded(plan, known_), "");
      Store store(file_, keys, {{"commit", commit_}});
      const Resumed resumed = store.resume(all, all, Retry::none);
      std::set<std::string> written;
      run_here(plan, resumed.missing, known_, root_, [&](const CellResult& r) {
        store.write(r);
        written.insert(plan.datasets[r.cell.dataset].label + " / " +
                       plan.methods[r.cell.method].label);
        if (random() % 2 != 0) return;
        store.sync();
        synced = written;
      });
    }
    synced = {"a / straight", "a / shifted", "b / straight", "b / shifted"};
    check();  // after the end of the sweep
    if (HasFailure()) break;
  }
  EXPECT_GT(lost, 0u) << "the simulation loses nothing at all";
}

}  // namespace
}  // namespace loopbench::faults_test
