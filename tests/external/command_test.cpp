// Programs as methods, started for each cell: exchange, checks, and what misbehaving ones cost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>

#include "datasets/core/error.hpp"
#include "datasets/core/params.hpp"
#include "harness/catalogue/arguments.hpp"
#include "harness/catalogue/command_metric.hpp"
#include "harness/catalogue/exchange.hpp"
#include "tests/support/program_sweep.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::command_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Arguments, AreSplitAsByAShellWithoutExpansions) {
  EXPECT_THAT(split_arguments("run", R"(a  'b "c' "d 'e" f\ g "" $HOME *)"),
              ElementsAre("a", "b \"c", "d 'e", "f g", "", "$HOME", "*"));
  EXPECT_THROW(split_arguments("run", "a 'b"), OptionError);
  EXPECT_THROW(split_arguments("run", "  "), OptionError);
  EXPECT_THAT(with_values({"{problem}/x", "{other}", "{", "a{result}"},
                          {{"problem", "/p q"}, {"result", "{problem}"}}),
              ElementsAre("/p q/x", "{other}", "{", "a{problem}"));
}

TEST(ResultMetadata, IsCheckedWhenRead) {
  const ResultMetadata metadata =
      parse_metadata(R"({"seconds": 0.5, "iterations": 7, "counts": {"a": 1}, "notes": ["x"]})");
  EXPECT_EQ(metadata.seconds, 0.5);
  EXPECT_EQ(metadata.report.counts.size(), 2u);
  EXPECT_THAT(metadata.report.notes, ElementsAre("x"));
  EXPECT_THROW(parse_metadata("{"), std::runtime_error);
  EXPECT_THROW(parse_metadata("[]"), std::runtime_error);
  EXPECT_THROW(parse_metadata(R"({"iterations": "many"})"), std::runtime_error);
}

using Command = test::ProgramSweep;

TEST_F(Command, CopyingTheKeyframesIsRaw) {
  folder_.file("copy.sh", "cp \"$1/keyframes.txt\" \"$2\"\n");
  const auto done =
      cells(entry("tum", "'sh copy.sh {problem} {result}'") +
            entry("g2o", R"("sh -c 'grep VERTEX $0/graph.g2o >$1' {problem} {result}")") +
            "  - {method: command, label: shell, shell: true, run: 'cp {problem}/keyframes.txt "
            "{result} && echo copied'}\n"
            "  - {method: command, label: dense, output: dense, run: 'sh copy.sh {problem} "
            "{result}'}\n" +
            "  - {method: command + cubic_spline, label: spline, run: 'sh copy.sh {problem} "
            "{result}'}\n");
  ASSERT_EQ(ran_.exit_code, 0) << ran_.out << ran_.err;
  const auto ate = errors();
  for (const char* label : {"tum", "g2o", "shell", "dense"}) {
    EXPECT_EQ(ate.at(label), ate.at("raw")) << label;
  }
  EXPECT_NEAR(ate.at("spline"), ate.at("raw"), 1e-12);
  ASSERT_EQ(done.size(), 6u);
  EXPECT_THAT(notes(done[3]), HasSubstr("output: copied"));
  EXPECT_THAT(notes(done[3]), HasSubstr("time: from start to end of the program"));
  EXPECT_EQ(done[1].phases.front().name, kExchangePhase);
}

TEST_F(Command, TheFolderHoldsNothingOfTheReference) {
  const auto done = cells(entry(
      "look",
      R"("sh -c 'ls $0 $0/..; echo data=$LOOPBENCH_DATA; cp $0/keyframes.txt $1' {problem} {result}")"));
  ASSERT_EQ(done.size(), 2u);
  EXPECT_THAT(notes(done[1]), HasSubstr("frames.txt graph.g2o keyframes.txt problem.json "));
  EXPECT_THAT(notes(done[1]), HasSubstr(": problem data=\n"));
}

TEST_F(Command, ResultJsonStatesTimeCountsAndRefusals) {
  folder_.file("state.sh",
               "cp $1/keyframes.txt $2\n"
               "echo '{\"seconds\": 0.0, \"iterations\": 7, \"notes\": [\"hello\"]}' >$2.json\n");
  folder_.file("decline.sh", "echo '{\"status\": \"declined\", \"why\": \"too flat\"}' >$2.json\n");
  const auto done = cells(entry("states", "'sh state.sh {problem} {result}'") +
                          entry("declines", "'sh decline.sh {problem} {result}'"));
  ASSERT_EQ(done.size(), 3u);
  EXPECT_LT(done[1].seconds, done[1].phases.front().seconds) << "of the run";
  EXPECT_THAT(done[1].worker.text(), testing::EndsWith(kStatedTimes));
  EXPECT_EQ(done[1].counts.front().value, 7.0);
  EXPECT_THAT(notes(done[1]), HasSubstr("hello\n"));
  EXPECT_THAT(notes(done[1]), HasSubstr("time: as stated by the program"));
  EXPECT_EQ(done[2].status, Status::declined);
  EXPECT_EQ(done[2].why, "too flat");
}

TEST_F(Command, AStatedTimeIsMarkedWithTheWallTimeBesideIt) {
  folder_.file("sleep.sh",
               "sleep 0.3; cp $1/keyframes.txt $2\n"
               "[ -z $3 ] || echo '{\"seconds\": 0.0}' >$2.json\n");
  const auto done = cells(entry("states", "'sh sleep.sh {problem} {result} x'") +
                          entry("silent", "'sh sleep.sh {problem} {result}'"));
  ASSERT_EQ(done.size(), 3u) << ran_.err;
  EXPECT_EQ(done[1].phases.front().name, kWallPhase);
  EXPECT_GE(done[1].phases.front().seconds, 0.3);
  EXPECT_GE(done[2].seconds, 0.3);
  EXPECT_THAT(ran_.out, testing::ContainsRegex("states .* [0-9.]+ \\(s\\) \\|\n"));
  EXPECT_THAT(ran_.out, testing::ContainsRegex("silent .* [0-9.]+ \\|\n"));
  EXPECT_THAT(ran_.out, HasSubstr("(s): as the program states it"));
  const std::string table = loopbench_command("table r --columns metric --format csv", folder_).out;
  EXPECT_THAT(table, HasSubstr(",states,time [ms],")) << "numbers have no mark";
  EXPECT_THAT(table, testing::Not(HasSubstr("(s)")));
}

TEST_F(Command, RunNamesMethodsWhoseTimedRunsDiffer) {
  folder_.file("unsteady.sh",
               "awk -v x=\"$(od -An -N2 -tu2 /dev/urandom)\" 'NR == 5 {$2 += 1e-6 * x} 1' "
               "$1/keyframes.txt >$2\n");
  const auto done =
      cells(entry("unsteady", "'sh unsteady.sh {problem} {result}'"), "timing: 3\nrepeats: 2\n");
  ASSERT_EQ(done.size(), 4u) << ran_.err;
  EXPECT_THAT(ran_.err,
              testing::ContainsRegex("unsteady: nondeterministic: 3 runs on the same input gave "
                                     "[23] different trajectories \\(and 1 more cells\\)\n"));
  EXPECT_THAT(ran_.err, testing::Not(HasSubstr("raw: ")));
}

TEST_F(Command, CpuTimeAndMemoryAreThoseOfTheProgram) {
  folder_.file("burn.py",
               "import sys, time\n"
               "block = bytearray(60 << 20)\n"
               "while time.process_time() < 0.2: pass\n"
               "open(sys.argv[2], 'w').write(open(sys.argv[1] + '/keyframes.txt').read())\n");
  const auto done = cells(entry("burns", "'python3 burn.py {problem} {result}'"));
  ASSERT_EQ(done.size(), 2u) << ran_.err;
  EXPECT_GE(done[1].cpu_seconds.value_or(0.0), 0.15) << done[1].why;  // sampled in a sandbox
  EXPECT_GE(done[1].peak_memory.value_or(0), 60 << 20);
  EXPECT_FALSE(done[1].added_memory) << "there is no earlier size of a new process";
}

TEST_F(Command, AnEstimateThatEqualsTheReferenceIsMarked) {
  const std::filesystem::path example = std::filesystem::path(LOOPBENCH_CONFIGS) / "example";
  for (const char* name : {"open.txt", "reference.txt"}) {
    std::filesystem::copy_file(example / name, folder_.path() / name);
  }
  // A second name, under which the reference is not hidden.
  std::filesystem::create_hard_link(folder_.path() / "reference.txt", folder_.path() / "other.txt");
  folder_.file("cheat.py",
               "import sys\n"
               "poses = {row.split()[0]: row for row in open(sys.argv[2]) if row[0] != '#'}\n"
               "with open(sys.argv[3], 'w') as out:\n"
               "    for row in open(sys.argv[1] + '/keyframes.txt'):\n"
               "        if row[0] != '#':\n"
               "            out.write(poses['%.3f' % float(row.split()[0])])\n");
  folder_.file("c.yaml",
               "datasets: [{dataset: trajectory, estimate: open.txt, reference: reference.txt, "
               "label: own}]\nmethods:\n  - raw\n" +
                   entry("cheat",
                         "'python3 cheat.py {problem} " + (folder_.path() / "other.txt").string() +
                             " {result}'") +
                   "metrics: [ate]\ntimes: keyframes\n");
  ran_ = loopbench_command("run c.yaml --out r", folder_);
  const auto done = read_cells(folder_.path() / "r");
  ASSERT_EQ(done.size(), 2u) << ran_.err;
  EXPECT_FALSE(done[0].oracle);
  EXPECT_NEAR(errors().at("cheat"), 0.0, 1e-9) << done[1].why;
  EXPECT_TRUE(done[1].oracle);
  EXPECT_THAT(notes(done[1]), HasSubstr("oracle (equals the reference)"));
}

TEST_F(Command, AMisbehavingProgramCostsItsOwnCell) {
  const std::vector<std::array<std::string, 3>> all{
      {"crash", R"("sh -c 'kill -SEGV $$' {problem} {result}")", "ended by SIGSEGV"},
      {"exit", R"("sh -c 'echo sorry; exit 3' {problem} {result}")", "its output ends with: sorry"},
      {"flood", R"("sh -c 'yes | head -c 3000000; exit 1' {problem} {result}")", "y y"},
      {"half",
       R"("sh -c 'head -n 20 $0/keyframes.txt >$1' {problem} {result}")",
       "result: has 20 poses, expected 40"},
      {"cut", R"("sh -c 'head -c 999 $0/keyframes.txt >$1' {problem} {result}")", "result:"},
      {"nan", "'sh nan.sh {problem} {result}'", "result:1:"},
      {"stamps",
       R"("awk '{$1 += 0.5; print > R}' R={result} {problem}/keyframes.txt")",
       "has stamp 0.5, expected 0.0 of the keyframe"},
      {"elsewhere",
       "'cp {problem}/keyframes.txt {problem}/../elsewhere{result}'",
       "exited with code 1"},
      {"nothing", "'true {problem} {result}'", "the program wrote no result"},
      {"absent", "'./absent {problem} {result}'", "cannot be started: No such file"},
      {"device",
       R"("sh -c 'ln -s /dev/zero $1' {problem} {result}")",
       "result: is not a regular file"},
      {"json",
       R"("sh -c 'cp $0/keyframes.txt $1; echo [ >$1.json' {problem} {result}")",
       "result.json: "}};
  folder_.file("nan.sh", "sed 's/ [^ ]*/ nan/' $1/keyframes.txt >$2\n");
  std::string entries;
  for (const auto& each : all) entries += entry(each[0], each[1]);
  const auto done = cells(entries + "  - uniform\n");
  ASSERT_EQ(done.size(), all.size() + 2) << ran_.err;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(done[i + 1].status, Status::failed) << all[i][0] << ": " << done[i + 1].why;
    EXPECT_THAT(done[i + 1].why.text(), HasSubstr(all[i][2])) << all[i][0];
    EXPECT_LT(done[i + 1].why.text().size(), 2200u) << "output is cut off";
  }
  EXPECT_EQ(done.back().status, Status::ok);
}

TEST_F(Command, CellsAreKeyedByTheProgramsFilesAndVersion) {
  folder_.file("copy.sh", "cp $1/keyframes.txt $2\n");
  folder_.file("data", "1");
  folder_.file("number", "1");
  const std::string method =
      "  - {method: command, run: 'sh copy.sh {problem} {result}', depends: data, version: 'cat "
      "number'}\n";
  const auto stored = [&] {
    cells(method);
    const std::size_t at = ran_.out.find("2 of 2 cells done");
    return at == std::string::npos ? ran_.out + ran_.err : ran_.out.substr(at, 50);
  };
  stored();
  EXPECT_THAT(stored(), HasSubstr("(2 of them in earlier runs)"));
  for (const char* file : {"copy.sh", "data", "number"}) {
    folder_.file(file, read_all(folder_.path() / file) + "\n");
    EXPECT_THAT(stored(), HasSubstr("(1 of them in earlier runs)")) << file;
    EXPECT_THAT(stored(), HasSubstr("(2 of them in earlier runs)")) << file;
  }
  std::filesystem::remove(folder_.path() / "data");
  cells(method);
  EXPECT_THAT(ran_.err, HasSubstr("depends: "));
}

TEST(MetricResult, ItsMistakesAreNamed) {
  const auto why = [](const std::string& text) {
    return refusal_of([&] { parse_scores(text, 0, 2); });
  };
  EXPECT_EQ(why(R"({"scores": []})"), "result: has no scores");
  EXPECT_EQ(why(R"({})"), "result: has no scores");
  EXPECT_EQ(why(R"({"scores": [{"name": "a", "unit": "m", "value": 1, "beter": "higher"}]})"),
            "result: a score: found key 'beter', expected name, axis, unit, value, values, better, "
            "target");
  EXPECT_EQ(why(R"({"scores": [{"name": "a", "value": 1}]})"), "result: a: has no unit");
  const std::string both = R"({"name": "a", "unit": "m", "value": 1, "values": [1]})";
  EXPECT_EQ(why(R"({"scores": [)" + both + "]}"), "result: a: expected either value or values");
  const std::string one = R"({"name": "a", "unit": "m", "value": 1})";
  EXPECT_EQ(why(R"({"scores": [)" + one + "," + one + "]}"), "result: two scores are named 'a'");
  EXPECT_THAT(why(R"({"secnds": 1})"),
              HasSubstr("result.json: found key 'secnds', expected status"));
}

TEST(MetricResult, RunStatesWhyAMetricFailed) {
  const TemporaryFolder folder;
  folder.file(
      "c.yaml",
      "datasets: [{dataset: simulated, path: room, keyframes: 40}]\nmethods: [raw, dual]\n"
      "metrics: [ate, {metric: command, label: bad, run: 'false {evaluation} {result}'}]\n");
  const CommandResult ran = loopbench_command("run c.yaml --no-sandbox --out r", folder);
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.out, HasSubstr("- raw, dual: bad failed: the program exited with code 1\n"));
}

TEST(MetricResult, AValueForEachPairIsKept) {
  const auto kept = [](std::size_t pairs) {
    return parse_scores(R"({"scores": [{"name": "a", "unit": "m", "values": [3, 4]}]})", 0, pairs)
        .front()
        .per_pose;
  };
  EXPECT_THAT(kept(2), ElementsAre(3.0, 4.0));
  EXPECT_THAT(kept(3), ElementsAre());
}

TEST_F(Command, ImpossibleOptionsAreRejectedWithTheirLine) {
  const auto error = [&](const std::string& entry) {
    folder_.file("c.yaml", "datasets: [simulated]\nmethods:\n  - " + entry + "\nmetrics: [ate]\n");
    return loopbench_command("run c.yaml --dry-run", folder_).err;
  };
  EXPECT_THAT(error("command"), HasSubstr("c.yaml:3: command: run: expected either run or serve"));
  EXPECT_THAT(error("{method: command, run: solve {problem}}"), HasSubstr("c.yaml:3"));
  EXPECT_THAT(error("{method: command, run: 'solve {problem}'}"),
              HasSubstr("run: does not contain {result}"));
  EXPECT_THAT(error("{method: command, run: \"solve '{problem} {result}\"}"),
              HasSubstr("is not closed"));
  EXPECT_THAT(error("{method: command + dm_n4, output: dense, run: 'solve {problem} {result}'}"),
              HasSubstr("has no smoother"));
}

}  // namespace
}  // namespace loopbench::command_test
