/// Worker processes: a crash affects only its own cell.
#include <gmock/gmock.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <csignal>

#include "harness/sweep/catalogue/load_sequence.hpp"
#include "harness/sweep/config/read_sweep.hpp"
#include "harness/sweep/run/cell_queue.hpp"
#include "harness/sweep/run/pack.hpp"
#include "methods/function_method.hpp"
#include "tests/support/isolated_fixture.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::tiny::isolate_test {
namespace {

using Isolated = IsolatedFixture;

const char* const kConfig =
    "datasets: [{dataset: line, sweep: {bias: [0.1, 0.2, 0.3]}}]\n"
    "methods: [straight, shift, {method: shift, fail: true, label: f},\n"
    "          {method: shift, decline: true, label: d}]\n"
    "metrics: [ate, {metric: ate, power: 2, label: undefined}]\nrepeats: 3\n";

std::string bytes(CellResult result) {
  result.seconds.clear();
  result.cpu_seconds.clear();
  result.peak_memory = result.added_memory = std::nullopt;
  result.worker = {};
  for (Phase& phase : result.report.phases) phase.seconds = 0.0;
  Packer pack;
  pack(result.status)(result.why)(result.scores)(result.report.counts)(result.trace.samples);
  pack(result.report.phases);
  return pack.bytes();
}

TEST_F(Isolated, GivesTheSameBitsAsOneProcess) {
  const Sweep sweep = parse_sweep(kConfig, "c.yaml", known_);
  const std::vector<Cell> planned = cells(sweep, seeded(sweep, known_), "");
  std::vector<std::string> in_process;
  run_here(sweep, planned, known_, {}, [&](const CellResult& result) {
    in_process.push_back(bytes(result));
  });
  for (const int jobs : {1, 3, 10}) {
    const std::vector<CellResult> isolated = run(sweep, planned, jobs);
    ASSERT_EQ(isolated.size(), planned.size());
    for (std::size_t i = 0; i < planned.size(); ++i) {
      EXPECT_EQ(bytes(isolated[i]), in_process[i]) << i;
      EXPECT_TRUE(isolated[i].worker.isolated);
      ASSERT_TRUE(isolated[i].metadata);
      EXPECT_EQ(isolated[i].metadata->size.keyframes, 4);
    }
  }
}

std::atomic<int>* shared_counter = nullptr;  // of all processes

TEST_F(Isolated, ACellEndedByASignalFromOutsideRunsAgain) {
  // As a scheduler does that ends all processes of a job in any order, the sweep last.
  void* memory = mmap(
      nullptr, sizeof(std::atomic<int>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  shared_counter = new (memory) std::atomic<int>(0);
  known_.methods.push_back(method("killed_once", "", [](const Problem& problem) {
    if ((*shared_counter)++ == 0) raise(SIGTERM);
    return problem.keyframes;
  }));
  known_.datasets.push_back(line_after("killed_line", [] {
    if ((*shared_counter)++ == 0) raise(SIGKILL);
  }));
  const char* const text = "metrics: [ate]\nmethods: [killed_once, straight]\n";
  for (const std::string dataset : {"line", "killed_line"}) {
    *shared_counter = 0;
    expect_ok("datasets: [" + dataset + "]\n" + text, 1, 2);
    EXPECT_GE(*shared_counter, 2) << dataset;
  }
  munmap(memory, sizeof(std::atomic<int>));
}

TEST_F(Isolated, TimedCellsRunAloneOnOneCore) {
  const std::vector<CellResult> results =
      run("datasets: [line]\nmethods: [straight, shift]\nmetrics: [ate]\ntiming: true\n", 2);
  ASSERT_EQ(results.size(), 2u);
  for (const CellResult& result : results) {
    EXPECT_TRUE(result.worker.serial);
    EXPECT_TRUE(result.worker.pinned);
    EXPECT_GE(result.seconds.size(), 5u);  // until the CPU time is known to 2 %
    EXPECT_LE(result.seconds.size(), 100u);
    EXPECT_EQ(result.cpu_seconds.size(), result.seconds.size());
  }
}

TEST_F(Isolated, ABrokenDatasetEndsItBeforeTheFirstCell) {
  known_.datasets.push_back(
      line_after("broken", [] { throw InputError("broken.txt: no such file"); }));
  EXPECT_EQ(refusal_of(
                [&] { run("datasets: [line, broken]\nmethods: [straight]\nmetrics: [ate]\n", 2); }),
            "broken.txt: no such file (c.yaml:1)");
  EXPECT_TRUE(results_.empty());
}

TEST_F(Isolated, ADatasetThatCrashesCostsItsCells) {
  known_.datasets.push_back(line_after("crash", [] { std::abort(); }));
  const std::vector<CellResult> results =
      run("datasets: [crash, line]\nmethods: [straight, shift]\nmetrics: [ate]\n", 2);
  ASSERT_EQ(results.size(), 4u);
  EXPECT_EQ(results[0].status, Status::crashed);
  EXPECT_THAT(results[0].why, testing::HasSubstr("while loading"));
  EXPECT_EQ(results[1].status, Status::crashed);
  EXPECT_EQ(results[2].status, Status::ok);
}

TEST_F(Isolated, ASequenceThatExceedsALimitIsNotLoadedForEachOfItsCells) {
  void* memory = mmap(
      nullptr, sizeof(std::atomic<int>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  auto& loads = *new (memory) std::atomic<int>(0);
  known_.datasets.push_back(line_after("slow", [&] {
    ++loads;
    for (;;) pause();
  }));
  const std::vector<CellResult> results =
      run("datasets: [slow, line]\nmethods: [straight, {method: shift, sweep: {by: [1, 2, 3]}}]\n"
          "metrics: [ate]\nlimits: {seconds: 4.5}\n",
          2);
  ASSERT_EQ(results.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(results[i].status, i < 4 ? Status::timeout : Status::ok) << results[i].why;
    EXPECT_EQ(results[i].why, i < 4 ? "loading its sequence exceeded the time limit of 4.5 s" : "");
  }
  EXPECT_EQ(loads, 1);
  munmap(memory, sizeof(std::atomic<int>));
}

TEST(CellQueue, KeepsAWorkerAtItsSequenceThenHelpsOut) {
  // Sequences 0: cells 0 1 2, 1: cells 3 4.
  std::vector<Cell> planned;
  for (std::size_t i = 0; i < 5; ++i) planned.push_back({i, i < 3 ? 0u : 1u, i, 0});
  CellQueue queue(planned);
  EXPECT_EQ(queue.first_of_datasets(), (std::vector<std::size_t>{0, 3}));
  std::optional<std::size_t> a;
  std::optional<std::size_t> b;
  EXPECT_EQ(queue.next(a), 0u);
  EXPECT_EQ(queue.next(b), 3u);
  EXPECT_EQ(queue.next(b), 4u);
  EXPECT_EQ(queue.next(b), 1u);
  queue.requeue(1);
  EXPECT_EQ(queue.next(a), 1u);
  EXPECT_EQ(queue.next(a), 2u);
  EXPECT_EQ(queue.next(a), std::nullopt);
  queue.requeue(4);
  EXPECT_EQ(queue.next(a), 4u);
  EXPECT_FALSE(queue.finish(3));
  EXPECT_TRUE(queue.finish(4));
}

TEST(Pack, RefusesAMessageThatIsCutOff) {
  CellResult result;
  result.why = "because";
  result.scores.resize(2);
  result.trace.samples.resize(3);
  Packer pack;
  pack(result);
  const std::string& whole = pack.bytes();
  CellResult back;
  Unpacker all(whole);
  all(back);
  EXPECT_EQ(back.why, "because");
  EXPECT_EQ(back.scores.size(), 2u);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    CellResult none;
    Unpacker cut(std::string_view(whole).substr(0, size));
    EXPECT_THROW(cut(none), std::runtime_error) << size;
  }
}

TEST(Pack, GivesASequenceBackBitForBit) {
  Sequence sequence;
  sequence.name = "s";
  sequence.problem = test::circle(7);
  sequence.problem.frames = sequence.problem.keyframes;
  sequence.problem.planar = true;
  sequence.problem.shared_landmarks = {3, 1, 4, 1, 5, 9};
  sequence.problem.anchors = {{2, {1.0, 2.0, 3.0}, 0.5 * Matrix3::Identity(), {0.1, 0.2, 0.3}}};
  sequence.problem.closures.back().scale = 1.5;
  sequence.reference = sequence.problem.keyframes;
  sequence.provenance.inputs = {{"folder/a b.txt", "estimate"}, {"c.txt"}};
  sequence.provenance.notes = {"n"};
  sequence.provenance.body_from_reference = Pose{Rotation(0.5, 0.5, 0.5, 0.5), {1.0, 2.0, 3.0}};
  sequence.provenance.noise = "stream 1";
  sequence.loop_candidates = {{1, 2, 0.5, true}};
  sequence.false_closures = {{0, 2}};
  Packer first;
  first(sequence);
  Sequence back;
  Unpacker unpack(first.bytes());
  unpack(back);
  Packer second;
  second(back);
  EXPECT_EQ(second.bytes(), first.bytes());
  EXPECT_EQ(back.provenance.inputs[0].path, "folder/a b.txt");
  const Edge& edge = back.problem.closures.back();
  EXPECT_EQ(edge.information, sequence.problem.closures.back().information);
  EXPECT_EQ(edge.from_from_to.rotation.coeffs(),
            sequence.problem.closures.back().from_from_to.rotation.coeffs());
  ASSERT_EQ(back.problem.anchors.size(), 1u);
  EXPECT_EQ(back.problem.anchors[0].point_in_body, Vector3(0.1, 0.2, 0.3));
  EXPECT_EQ(back.false_closures, sequence.false_closures);
  EXPECT_EQ(back.provenance.body_from_reference->translation, Vector3(1.0, 2.0, 3.0));
}

}  // namespace
}  // namespace loopbench::tiny::isolate_test
