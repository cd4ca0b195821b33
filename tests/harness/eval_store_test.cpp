// `eval --store`: statistics over the runs of systems, as a store.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "harness/eval/recorded_sweep.hpp"
#include "harness/store/merge.hpp"
#include "harness/store/read.hpp"
#include "harness/store/sqlite.hpp"
#include "tests/support/eval_command.hpp"
#include "tests/support/recorded_files.hpp"

namespace loopbench::eval_store_test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using namespace harness;

class EvalStore : public test::RecordedFiles {};

TEST_F(EvalStore, RunsAreRepeatsAndSystemsAreMethods) {
  const std::string out = store_systems("store");
  EXPECT_THAT(out, HasSubstr("40 runs in"));
  EXPECT_THAT(out, ContainsRegex("\n\\| office, bad +\\| +0[.0-9]+ ± [.0-9]+ +\\|"));
  EXPECT_THAT(out, HasSubstr("good is"));  // the verdict
  EXPECT_THAT(out, HasSubstr("20 runs"));
  const auto cells = read_cells(path("store"));
  ASSERT_EQ(cells.size(), 40u);
  EXPECT_EQ(cells.back().repeat, 9);
  const Comparison comparison = compared("store");
  EXPECT_EQ(comparison.groups, 20u);
  EXPECT_TRUE(comparison.is_best);
  EXPECT_EQ(comparison.methods.at(0).method, "good");
}

TEST_F(EvalStore, NumbersAreThoseOfEval) {
  store_systems("store");
  const test::Json json = test::eval_json(office({"bad/office/3"}));
  const double expected = test::find(json, "ate", "translation")["rmse"];
  for (const Record& r : read_records(path("store"))) {
    if (r.cell->sequence == "office" && r.cell->method == "bad" && r.cell->repeat == 3 &&
        r.kind->label == "ate" && r.kind->relation == "translation" && r.kind->axis == "3d") {
      EXPECT_DOUBLE_EQ(r.statistics.rmse, expected);
      return;
    }
  }
  FAIL() << "no such record";
}

TEST_F(EvalStore, AFileThatAKilledProgramLeftWithoutTablesIsNew) {
  for (const char* sql : {"", "PRAGMA journal_mode = WAL", "PRAGMA user_version = 0; VACUUM"}) {
    std::filesystem::remove_all(path("s"));
    std::filesystem::create_directories(path("s"));
    Database(path("s") + "/results.sqlite", Database::Mode::create).execute(sql);
    EXPECT_THROW(read_cells(path("s")), InputError) << sql;
    EXPECT_THAT(stored(office({"good/office/0"}), kExitOk, "s"), HasSubstr("1 run")) << sql;
    EXPECT_EQ(read_cells(path("s")).size(), 1u) << sql;
  }
}

TEST_F(EvalStore, LaterCallsAddRunsAndKeepTheOthers) {
  stored(office({"good/office/0"}));
  EXPECT_THAT(stored(office({"bad/office/0", "bad/office/1"})), HasSubstr("3 runs in"));
  EXPECT_EQ(read_cells(path("store")).size(), 3u);
  EXPECT_THAT(stored(office({"bad/office/1"})), HasSubstr("(3 stored before)"));
  write_run("systems/bad", "office", 1, 0.5);  // changed: evaluated again
  EXPECT_THAT(stored(office({"bad/office/1"})), HasSubstr("(2 stored before)"));
}

TEST_F(EvalStore, ARunThatCannotBeReadIsAFailureUntilItIsRepaired) {
  const std::string broken = path("systems/bad/office/3.txt");
  std::ofstream(broken) << "1 2 3\n";
  for (int call = 0; call < 2; ++call) {
    const std::string out = store_systems("store", {}, kExitSomeCellsFailed);
    EXPECT_THAT(out, ContainsRegex("\n\\| office, bad +\\| +0[.0-9]+ ± [.0-9]+ \\(9 of 10\\) \\|"));
    EXPECT_THAT(out, HasSubstr("1 failed\nfailed: " + broken));
  }
  write_run("systems/bad", "office", 3, 0.034);
  const std::string out = stored(files_of("office"));
  EXPECT_THAT(out, HasSubstr("(39 stored before)"));
  EXPECT_THAT(out, ContainsRegex("\n\\| office, bad +\\| +0[.0-9]+ ± [.0-9]+ +\\|"));
}

/// Sets the current folder until its end.
class InFolder {
 public:
  explicit InFolder(const std::string& folder) { std::filesystem::current_path(folder); }
  ~InFolder() { std::filesystem::current_path(before_); }
  InFolder(const InFolder&) = delete;
  InFolder& operator=(const InFolder&) = delete;

 private:
  std::filesystem::path before_ = std::filesystem::current_path();
};

TEST_F(EvalStore, RelativeNamesInSeveralFoldersAreDifferentFiles) {
  for (const std::string dot : {"", "./"}) {
    const std::string store = path(dot.empty() ? "store" : "dots");
    for (const std::string sequence : {"seq1", "seq2"}) {
      write(sequence + "/ref.txt", path_of(0.0));
      write(sequence + "/sys.txt", path_of(sequence == "seq1" ? 0.01 : 0.05));
      const InFolder folder(path(sequence));
      test::eval({dot + "ref.txt", dot + "sys.txt", "--store", store});
    }
    const auto cells = read_cells(store);
    ASSERT_EQ(cells.size(), 2u);
    EXPECT_EQ(cells[0].sequence, "seq1");
    EXPECT_EQ(cells[1].sequence, "seq2");
    const auto runs = runs_of_manifest(read_run(store)["config"]);
    EXPECT_EQ(runs.at(0).estimate, path("seq1/sys.txt"));
    EXPECT_EQ(runs.at(1).estimate, path("seq2/sys.txt"));
  }
}

TEST_F(EvalStore, AnUnreadableReferenceLeavesTheStoreUnchanged) {
  store_systems("s");
  std::ofstream(path("truths/street.txt")) << "1 2 3\n";
  const std::vector<std::string> options{"--align", "sim3", "--store", path("s")};
  EXPECT_THAT(test::refusal<InputError>(test::with(office({"bad/office/1"}), options)),
              HasSubstr("street.txt"));
  const auto cells = read_cells(path("s"));
  EXPECT_EQ(cells.size(), 40u);
  for (const CellRow& cell : cells) EXPECT_EQ(cell.status, Status::ok);
}

TEST_F(EvalStore, OtherOptionsEvaluateEarlierRunsAgainWithANote) {
  store_systems("store");
  const auto notes = [&](const std::vector<std::string>& options) {
    testing::internal::CaptureStderr();
    stored(test::with(office({"bad/office/1"}), options));
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_THAT(notes({}), Not(HasSubstr("evaluated again")));
  EXPECT_THAT(notes({"--align", "sim3"}), HasSubstr("39 earlier runs are evaluated again"));
}

TEST_F(EvalStore, MergedStoresGoOn) {
  const auto store_of = [&](const std::string& method, const std::string& repeats) {
    const std::vector<std::string> options{"--repeats", repeats};
    stored(test::with(office({method + "/office/0"}), options), kExitOk, method + repeats);
    return folder_.path() / (method + repeats);
  };
  const std::filesystem::path good = store_of("good", "refuse");
  merge_stores({good, store_of("bad", "refuse")}, path("merged/results.sqlite"), {});
  const std::string out = stored(office({"good/office/1"}), kExitOk, "merged");
  EXPECT_THAT(out, HasSubstr("3 runs in"));
  EXPECT_THAT(out, HasSubstr("(2 stored before)"));
  EXPECT_THROW(merge_stores({good, store_of("bad", "keep_last")}, path("other.sqlite"), {}),
               InputError);
}

TEST_F(EvalStore, EvalStatesWhyThereIsNoVerdict) {
  const std::string first = write("x/same/est.txt", path_of(0.01));
  const std::string second = write("y/same/est.txt", path_of(0.01));
  EXPECT_THAT(test::eval({path("truths/office.txt"), first, second}),
              HasSubstr("no verdict: " + second + ": has the same sequence"));
}

}  // namespace
}  // namespace loopbench::eval_store_test
