/// Keys, resuming, what is refused, traces, merging: on the tiny catalogue, in this process.
#include "harness/store/store.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "harness/config/read_sweep.hpp"
#include "harness/run/run_sweep.hpp"
#include "harness/store/merge.hpp"
#include "tests/support/store_text.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/tiny_catalogue.hpp"

namespace loopbench {
namespace {

using Labels = std::vector<std::string>;

/// The bias of the tiny line, from a file.
struct FileOptions {
  std::string path;
};
template <class Visit>
void fields(FileOptions& o, Visit visit) {
  visit("path", o.path, "file with the bias");
}
Sequence load_file(const FileOptions& options, const DataRoot& root) {
  const std::filesystem::path file = root.find(options.path);
  tiny::LineOptions line;
  std::ifstream(file) >> line.bias;
  Sequence out = tiny::load_line(line, root);
  out.provenance.inputs = {file};
  return out;
}

std::string config(const std::string& methods, const std::string& more = "") {
  return "datasets: [{dataset: line, bias: 0.1, label: a}, {dataset: line, bias: 0.2, label: b}]\n"
         "methods: [" +
         methods + "]\nmetrics: [ate]\nbaseline: straight\n" + more;
}
const std::string kUsual = config("straight, {method: shift, by: 1, label: shifted}");

class StoreTest : public testing::Test {
 protected:
  struct Ran {
    Labels cells;  ///< "SEQUENCE / METHOD", in order
    Resumed resumed;
  };

  /// Runs what the store misses of the config, on one thread.
  Ran run(const std::string& text, Retry retry = Retry::none, const std::string& only = "") {
    const Sweep sweep = parse_sweep(text, folder_.path() / "c.yaml", known_);
    CellKeys keys(sweep, known_, root_, build_);
    const std::vector<bool> with_seed = seeded(sweep, known_);
    Store store(file_, keys, {{"commit", commit_}});
    Ran out;
    out.resumed = store.resume(cells(sweep, with_seed, ""), cells(sweep, with_seed, only), retry);
    Sequences sequences(sweep, known_, root_, out.resumed.missing);
    const std::atomic<bool> stop = false;
    run_sweep(sweep, out.resumed.missing, known_, sequences, 1, stop, [&](const CellResult& r) {
      store.write(r);
      out.cells.push_back(sweep.datasets[r.cell.dataset].label + " / " +
                          sweep.methods[r.cell.method].label);
    });
    return out;
  }

  Labels methods_of(const std::string& sequence) const {
    Labels out;
    for (const CellRecord& cell : read_cells(file_)) {
      if (cell.sequence == sequence) out.push_back(cell.method);
    }
    return out;
  }

  void expect_refused(const std::string& reason) {
    try {
      run(kUsual);
      ADD_FAILURE() << "was not refused";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "results.sqlite";
  DataRoot root_{{folder_.path()}};
  std::string build_ = "build one";
  std::string commit_ = "c0ffee";
  Catalogue known_ = [] {
    Catalogue out = tiny::catalogue();
    out.datasets.push_back(dataset<FileOptions>("file", "bias from a file", load_file));
    return out;
  }();
};

TEST_F(StoreTest, RunningAgainRunsNothing) {
  EXPECT_EQ(run(kUsual).cells.size(), 4u);
  const std::string before = store_text(file_);
  const Ran again = run(kUsual);
  EXPECT_EQ(again.cells, Labels{});
  EXPECT_EQ(again.resumed.there, 4u);
  EXPECT_TRUE(again.resumed.unchanged);
  EXPECT_EQ(store_text(file_), before);
}

TEST_F(StoreTest, AChangedOptionRunsExactlyTheCellsItTouches) {
  run(kUsual);
  const Ran changed = run(config("straight, {method: shift, by: 2, label: shifted}"));
  EXPECT_EQ(changed.cells, (Labels{"a / shifted", "b / shifted"}));
  EXPECT_EQ(read_cells(file_).size(), 4u);
  EXPECT_EQ(read_cells(file_)[1].method_options, "shift: by=2");
  EXPECT_EQ(run(kUsual).cells, Labels{}) << "what was there before is kept under its key";
  EXPECT_EQ(read_cells(file_)[1].method_options, "shift: by=1");
}

TEST_F(StoreTest, AChangedDatasetRunsItsCells) {
  run(kUsual);
  std::string text = kUsual;
  text.replace(text.find("0.2"), 3, "0.3");
  EXPECT_EQ(run(text).cells, (Labels{"b / straight", "b / shifted"}));
}

TEST_F(StoreTest, ANewMethodRunsAloneAndTakesItsPlace) {
  run(kUsual);
  const Ran more =
      run(config("{method: shift, by: 3}, straight, {method: shift, by: 1, label: shifted}"));
  EXPECT_EQ(more.cells, (Labels{"a / shift (by=3)", "b / shift (by=3)"}));
  EXPECT_EQ(methods_of("a"), (Labels{"shift (by=3)", "straight", "shifted"}));
  EXPECT_EQ(run(kUsual).cells, Labels{});
  EXPECT_EQ(methods_of("b"), (Labels{"straight", "shifted"}));
}

TEST_F(StoreTest, NamesAreNotContent) {
  run(kUsual);
  EXPECT_EQ(run(config("straight, {method: shift, by: 1.0, label: renamed}")).cells, Labels{});
  EXPECT_EQ(methods_of("a"), (Labels{"straight", "renamed"}));
  EXPECT_EQ(run(config("straight, shift")).cells, Labels{}) << "1 is the default";
}

TEST_F(StoreTest, TwoCellsOfOneContentKeepTheirNames) {
  const std::string twins =
      config("straight, {method: shift, label: one}, {method: shift, label: two}");
  EXPECT_EQ(run(twins).cells.size(), 6u);
  EXPECT_EQ(run(twins).cells, Labels{});
  EXPECT_EQ(methods_of("a"), (Labels{"straight", "one", "two"}));
}

TEST_F(StoreTest, WhatJudgesIsContent) {
  run(kUsual);
  for (const char* more : {"min_coverage: 0.5\n",
                           "times: keyframes\n",
                           "protocol: {base: loopbench, align: none}\n",
                           "timing: 2\n",
                           "traces: false\n"}) {
    EXPECT_EQ(run(kUsual + more).cells.size(), 4u) << more;
  }
  EXPECT_EQ(run(kUsual + "limits: {seconds: 5}\n").cells, Labels{}) << "a limit is not";
}

TEST_F(StoreTest, AnotherBuildRunsEverything) {
  run(kUsual);
  build_ = "build two";
  commit_ = "decaf";
  EXPECT_EQ(run(kUsual).cells.size(), 4u);
  EXPECT_EQ(read_cells(file_)[0].build, "build two");
  EXPECT_EQ(read_provenance(file_).at("commit"), "decaf");
}

TEST_F(StoreTest, ProvenanceTellsAllThatMadeIt) {
  run(kUsual, Retry::none, "a / ");
  commit_ = "decaf";  // a commit that leaves the code as it is
  EXPECT_EQ(run(kUsual).cells.size(), 2u);
  run(kUsual, Retry::failed);
  EXPECT_EQ(read_provenance(file_).at("commit"), "c0ffee\ndecaf");
}

TEST_F(StoreTest, FailuresAreKeptUntilToldOtherwise) {
  const std::string text = config("straight, {method: shift, fail: true, label: fails}");
  EXPECT_EQ(run(text).cells.size(), 4u);
  const Ran again = run(text);
  EXPECT_EQ(again.cells, Labels{});
  EXPECT_EQ(again.resumed.failed, 2u);
  EXPECT_EQ(run(text, Retry::failed).cells, (Labels{"a / fails", "b / fails"}));
  EXPECT_EQ(run(text, Retry::all).cells.size(), 4u);
  EXPECT_EQ(read_cells(file_).size(), 4u);
  EXPECT_EQ(read_records(file_).size(), 2u * 2u + 2u) << "the rows before are replaced";
}

TEST_F(StoreTest, OnlyLeavesTheOthersAsTheyAre) {
  EXPECT_EQ(run(kUsual, Retry::none, "b / straight").cells, Labels{"b / straight"});
  EXPECT_EQ(run(kUsual).cells, (Labels{"a / straight", "a / shifted", "b / shifted"}));
  EXPECT_EQ(methods_of("b"), (Labels{"straight", "shifted"}));
}

TEST_F(StoreTest, ChangedBytesOfAnInputRunItsCells) {
  folder_.file("x/bias", "0.1");
  folder_.file("bias2", "0.1");
  const std::string text =
      "datasets: [{dataset: file, path: x/bias, label: f}, {dataset: file, path: bias2, label: "
      "g}]\n"
      "methods: [straight]\nmetrics: [ate]\n";
  EXPECT_EQ(run(text).cells.size(), 2u);
  EXPECT_EQ(run(text).cells, Labels{});
  const auto time = std::filesystem::last_write_time(folder_.path() / "x/bias");
  folder_.file("x/bias", "0.2");  // as long as before, and as old
  std::filesystem::last_write_time(folder_.path() / "x/bias", time);
  EXPECT_EQ(run(text).cells, Labels{"f / straight"});
  EXPECT_EQ(read_inputs(file_).at("f").at(0).bytes, 3u);

  // The same bytes elsewhere are the same input; other bytes found first are not.
  std::filesystem::create_directories(folder_.path() / "moved");
  std::filesystem::rename(folder_.path() / "x", folder_.path() / "moved" / "x");
  root_.folders = {folder_.path(), folder_.path() / "moved"};
  EXPECT_EQ(run(text).cells, Labels{});
  folder_.file("x/bias", "0.4");
  EXPECT_EQ(run(text).cells, Labels{"f / straight"});
}

TEST_F(StoreTest, ASecondSweepIsToldOfTheFirst) {
  run(kUsual);
  const FolderLock first(folder_.path());
  expect_refused("another sweep is writing its results here");
}

TEST_F(StoreTest, ADamagedStoreIsRefused) {
  run(kUsual);
  const std::string sound = [&] {
    std::ifstream in(file_, std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(in), {}};
  }();
  const auto damaged = [&](std::size_t at, std::size_t size) {
    std::string bytes = sound;
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), size, '\x5a');
    std::ofstream(file_, std::ios::binary) << bytes;
  };
  damaged(0, 64);
  expect_refused("not a database");
  damaged(4096 + 100, sound.size() - 4096 - 200);
  expect_refused(file_.string());
  std::ofstream(file_, std::ios::binary) << sound.substr(0, sound.size() / 2);
  expect_refused(file_.string());
  std::ofstream(file_, std::ios::binary) << sound;
  EXPECT_EQ(run(kUsual).cells, Labels{});
}

TEST_F(StoreTest, AFileWithoutTablesIsBegunAnew) {
  std::ofstream(file_, std::ios::binary).flush();  // a kill between making it and its tables
  EXPECT_EQ(run(kUsual).cells.size(), 4u);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "previous.sqlite"));
}

TEST_F(StoreTest, ASchemaOfAnotherVersionIsRefused) {
  run(kUsual);
  Database(file_, Database::Mode::read).execute("PRAGMA user_version = 2");
  expect_refused("schema 2, expected 3");
}

TEST_F(StoreTest, TracesTellWhereItWasAndHowFarOff) {
  // Unaligned, the last keyframe of a is off by 0.1 + 1e-6 (its seed) in y alone.
  run(config("straight", "protocol: {base: loopbench, align: none}\ntimes: keyframes\n"));
  Traces traces(file_);
  const auto cell = traces.cell(0);
  ASSERT_TRUE(cell);
  EXPECT_EQ(cell->times, Times::keyframes);
  ASSERT_EQ(cell->samples.size(), 4u);
  const TraceSample& last = cell->samples.back();
  EXPECT_EQ(last.estimate.stamp, 3.0f);
  EXPECT_EQ(last.estimate.x, 3.0f);
  EXPECT_FLOAT_EQ(last.estimate.y, 9.100001f);
  EXPECT_EQ(last.estimate.qw, 1.0f);
  EXPECT_EQ(last.error_x, 0.0f);
  EXPECT_NEAR(last.error_y, 0.100001f, 1e-6f);
  EXPECT_EQ(last.error_angle, 0.0f);
  const auto sequence = traces.sequence(0);
  ASSERT_TRUE(sequence);
  EXPECT_EQ(sequence->reference.size(), 4u);
  EXPECT_EQ(sequence->reference[2].y, 4.0f);
  EXPECT_FLOAT_EQ(sequence->keyframes[3].y, 9.100001f);
  EXPECT_FALSE(traces.cell(7));
  EXPECT_EQ(read_cells(file_)[0].keyframes, 4);
}

TEST_F(StoreTest, TracesAreThinnedEvenlyAndCountFromTheFirstReferencePose) {
  Sequence sequence;
  for (int i = 0; i < 5001; ++i) {
    const Pose pose{Rotation::Identity(), Vector3(4e6 + i, 7.0, 0.0)};
    sequence.reference.push_back({1.5e9 + i, pose});
  }
  sequence.problem.keyframes = {sequence.reference[0], sequence.reference[5000]};
  sequence.problem.closures = {{0, 1, {}, Matrix6::Identity(), 1.0}};
  const SequenceTrace trace = sequence_trace(sequence);
  ASSERT_EQ(trace.reference.size(), kTraceSamples);
  EXPECT_EQ(trace.reference.front().x, 0.0f);
  EXPECT_EQ(trace.reference.back().x, 5000.0f);
  EXPECT_EQ(trace.reference.back().stamp, 5000.0f);
  EXPECT_EQ(trace.reference[1000].x, 2501.0f);  // 1000 * 5000 / 1999, rounded down
  EXPECT_EQ(trace.origin.x, 4e6);
  ASSERT_EQ(trace.closures.size(), 1u);
  EXPECT_EQ(trace.closures[0].to_stamp, 5000.0f);
  EXPECT_EQ(trace.closures[0].to_x, 4005000.0f);  // keyframes stay in their own world
}

TEST_F(StoreTest, MergedHalvesAreTheWhole) {
  run(kUsual);
  const std::string whole = store_text(file_);
  const std::filesystem::path parts[] = {folder_.path() / "1.sqlite", folder_.path() / "2.sqlite"};
  file_ = parts[0];
  run(kUsual, Retry::none, "a / |b / straight");
  file_ = parts[1];
  run(kUsual, Retry::none, "b / ");
  const std::filesystem::path out = folder_.path() / "merged" / "results.sqlite";
  const Merged merged = merge_stores({parts[1], parts[0]}, out, false);
  EXPECT_EQ(merged.cells, 4u);
  EXPECT_EQ(merged.twice, 1u);
  EXPECT_EQ(store_text(out), whole);
  EXPECT_THROW(merge_stores({parts[0], parts[1]}, out, false), InputError) << "it is there";
  file_ = out;
  EXPECT_EQ(run(kUsual).cells, Labels{}) << "and goes on like any other";
}

TEST_F(StoreTest, MergePrefersWhatDidNotFail) {
  const auto fails = [&] {
    const Sweep sweep = parse_sweep(kUsual, "c.yaml", known_);
    CellKeys keys(sweep, known_, root_, build_);
    Store store(file_, keys, {});
    CellResult r;
    r.cell = cells(sweep, seeded(sweep, known_), "").at(1);
    r.status = Status::failed;
    r.why = "not now";
    store.write(r);
  };
  file_ = folder_.path() / "1.sqlite";
  fails();
  file_ = folder_.path() / "2.sqlite";
  run(kUsual, Retry::none, "a / ");
  const std::filesystem::path out = folder_.path() / "3.sqlite";
  merge_stores({folder_.path() / "1.sqlite", file_}, out, false);
  for (const CellRecord& cell : read_cells(out)) EXPECT_EQ(cell.status, "ok");
  EXPECT_EQ(read_cells(out).size(), 2u);
}

TEST_F(StoreTest, MergeRefusesWhatDoesNotBelongTogether) {
  const std::filesystem::path one = file_ = folder_.path() / "1.sqlite";
  run(kUsual);
  const std::filesystem::path other_options = file_ = folder_.path() / "2.sqlite";
  run(config("straight, {method: shift, by: 2, label: shifted}"));
  const std::filesystem::path other_build = file_ = folder_.path() / "3.sqlite";
  build_ = "build two";
  run(kUsual);
  const std::filesystem::path out = folder_.path() / "out.sqlite";
  EXPECT_THROW(merge_stores({one, other_options}, out, false), InputError);
  EXPECT_THROW(merge_stores({one, other_build}, out, false), InputError);
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(merge_stores({one, other_build}, out, true).cells, 8u);
  Labels methods;
  for (const CellRecord& cell : read_cells(out)) {
    if (cell.sequence == "a") methods.push_back(cell.method);
  }
  EXPECT_EQ(
      methods,
      (Labels{"straight", "shifted", "straight (build build tw)", "shifted (build build tw)"}));
}

}  // namespace
}  // namespace loopbench
