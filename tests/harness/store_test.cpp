/// Store: keys, resuming, rejected files, traces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/tiny_store.hpp"

namespace loopbench::tiny_store::store_test {
namespace {

using StoreTest = TinyStore;

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
  std::string text = kUsual;
  text.replace(text.find("0.2"), 3, "0.3");
  EXPECT_EQ(run(text).cells, (Labels{"b / straight", "b / shifted"})) << "another dataset";
}

TEST_F(StoreTest, AScoreKeepsItsMetricsNameItsLabelAndItsDirection) {
  known_.metrics[0].score = [](const Evaluation&, const Params&) {
    return std::vector<Score>{single("translation", "3d", "m", 1.0),
                              directed(single("share", "", "%", 2.0), Better::higher),
                              directed(single("ratio", "", "1", 3.0), Better::target, 1.0),
                              directed(single("pairs", "", "1", 4.0), Better::neither)};
  };
  std::string text = kUsual;
  text.replace(text.find("metrics: [ate]"), 14, "metrics: [{metric: ate, label: gain}]");
  run(text);
  const std::vector<Record> records = read_records(file_);
  ASSERT_EQ(records.size(), 32u);  // four cells, at keyframes and densely
  const std::vector<Better> expected{
      Better::lower, Better::higher, Better::target, Better::neither};
  for (std::size_t i = 0; i < records.size(); ++i) {
    EXPECT_EQ(records[i].kind->metric, "ate");
    EXPECT_EQ(records[i].kind->label, "gain");
    EXPECT_EQ(records[i].kind->better, expected[i % 4]);
    EXPECT_EQ(records[i].kind->target, i % 4 == 2 ? 1.0 : 0.0);
  }
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

TEST_F(StoreTest, WhatEvaluatesIsContent) {
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
  commit_ = "decaf";  // a commit that does not change the code
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

TEST_F(StoreTest, KeepsHowAMethodCutUpTheWayAndAllThatADatasetIs) {
  run(kUsual);
  Traces traces(file_);
  const std::vector<Section> cut = traces.sections(1);
  ASSERT_EQ(cut.size(), 1u);
  EXPECT_EQ(cut[0].kind + " " + cut[0].what, "window shifted");
  EXPECT_EQ(cut[0].begin, 0.0);
  EXPECT_EQ(cut[0].end, 3.0);
  EXPECT_TRUE(traces.sections(0).empty());
  EXPECT_EQ(read_dataset_options(file_).at("b"), "line: bias=0.2, seed=1");
}

/// A polyline with an option whose value is a text.
struct Named final : Smoother {
  struct Options {
    std::string words = "none";
  };
  explicit Named(const Options&) {}
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report&) const override {
    return std::make_unique<Polyline>(problem.keyframes);
  }
};
template <class Visit>
void fields(Named::Options& o, Visit visit) {
  visit("words", o.words, "unused");
}

TEST_F(StoreTest, OptionsOfMethodsAreDataNotParsedFromTheirText) {
  known_.methods.push_back(method<Named>("named", "a polyline"));
  run(config("straight, {method: named, words: 'a, other=7; + b', label: n}"));
  const std::vector<Record> records = read_records(file_);
  const auto named =
      std::ranges::find_if(records, [](const Record& r) { return r.cell->method.text() == "n"; });
  ASSERT_NE(named, records.end());
  EXPECT_EQ(field(*named, "words"), "a, other=7; + b");
  EXPECT_FALSE(has_field(*named, "other"));
  EXPECT_TRUE(has_field(records.front(), "by"));
  EXPECT_EQ(field(records.front(), "by"), "0.0");
  EXPECT_EQ(read_cells(file_).front().dataset->front(), (Choice{"line", {{"bias", 0.1}}}));
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
  folder_.file("x/bias", "0.2");  // same size and date as before
  std::filesystem::last_write_time(folder_.path() / "x/bias", time);
  EXPECT_EQ(run(text).cells, Labels{"f / straight"});
  EXPECT_EQ(read_inputs(file_).at("f").at(0).bytes, 3u);

  // Equal bytes at another path are the same input; other bytes found first are not.
  std::filesystem::create_directories(folder_.path() / "moved");
  std::filesystem::rename(folder_.path() / "x", folder_.path() / "moved" / "x");
  root_.folders = {folder_.path(), folder_.path() / "moved"};
  EXPECT_EQ(run(text).cells, Labels{});
  folder_.file("x/bias", "0.4");
  EXPECT_EQ(run(text).cells, Labels{"f / straight"});
}

TEST_F(StoreTest, ADamagedStoreIsRefused) {
  run(kUsual);
  const std::string sound = read_all(file_);
  std::ofstream(file_, std::ios::binary) << std::string(64, '\x5a') << sound.substr(64);
  expect_refused("not a database");
  std::ofstream(file_, std::ios::binary) << sound.substr(0, sound.size() / 2);
  expect_refused(file_.string());
}

TEST_F(StoreTest, AFileWithoutTablesIsBegunAnew) {
  std::ofstream(file_, std::ios::binary)
      .flush();  // killed between creating the file and its tables
  EXPECT_EQ(run(kUsual).cells.size(), 4u);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "previous-1.sqlite"));
}

TEST_F(StoreTest, ASchemaOfAnotherVersionIsRefused) {
  run(kUsual);
  Database(file_, Database::Mode::read).execute("PRAGMA user_version = 2");
  expect_refused("schema 2, expected 20");
  Database(file_, Database::Mode::read).execute("PRAGMA user_version = 19");  // with other traces
  expect_refused("schema 19, expected 20); run its config again: --fresh keeps it");
}

TEST_F(StoreTest, TracesTellWhereItWasAndHowFarOff) {
  // Not aligned: the last keyframe of a has an error of 0.1 + 1e-6 (its seed) in y only.
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
  EXPECT_FLOAT_EQ(last.estimate.distance, std::sqrt(2.0f) + std::sqrt(10.0f) + std::sqrt(26.0f));
  EXPECT_EQ(last.error_x, 0.0f);
  EXPECT_NEAR(last.error_y, 0.100001f, 1e-6f);
  EXPECT_EQ(last.error_angle, 0.0f);
  const auto sequence = traces.sequence(0);
  ASSERT_TRUE(sequence);
  EXPECT_EQ(sequence->reference.size(), 4u);
  EXPECT_NEAR(sequence->reference[2].y, 4.0f, 9.0f / (2 * kFineSteps));
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
  EXPECT_EQ(trace.closures[0].to_x, 4005000.0f);  // keyframes are not relative to the origin
}

}  // namespace
}  // namespace loopbench::tiny_store::store_test
