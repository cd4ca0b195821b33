/// The program as a process: dry runs, exit codes, messages, output files.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.hpp"

namespace loopbench::cli_test {
namespace {

using testing::HasSubstr;

const char* const kConfig =
    "datasets:\n"
    "  - {dataset: simulated, path: office, closures: {max: 0}, label: a}\n"
    "  - {dataset: simulated, path: room, keyframes: 60, label: b}\n"
    "methods: [raw, uniform, cubic_spline]\n"
    "metrics: [ate, {metric: rpe, label: rpe}]\n";

class Cli : public testing::Test {
 protected:
  CommandResult run(const std::string& arguments) { return loopbench_command(arguments, folder_); }
  /// `run --dry-run` of a config with one dataset.
  CommandResult dry_run(const std::string& dataset) {
    folder_.file("c.yaml", "datasets:\n  - {" + dataset + "}\nmethods: [raw]\nmetrics: [ate]\n");
    return run("run c.yaml --dry-run");
  }
  TemporaryFolder folder_;
};

TEST_F(Cli, TellsItsVersion) {
  EXPECT_EQ(successful_command("--version", folder_).out, "loopbench " LOOPBENCH_VERSION "\n");
}

TEST_F(Cli, WrongCommandLinesExitWithTwo) {
  for (const char* arguments :
       {"rnu", "run", "run x.yaml --jobs 0", "run x.yaml --no-such-flag", "table"}) {
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_NE(result.err, "") << arguments;
  }
}

TEST_F(Cli, DryRunFindsAMissingEstimate) {
  const CommandResult result = dry_run("dataset: trajectory, label: mine, estimate: 007");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("mine: 007: no such file (looked in "));
  EXPECT_NE(result.err.find("1 of the sequences above cannot be loaded"), std::string::npos);
  EXPECT_NE(result.out.find("0  mine / raw"), std::string::npos) << result.out;
}

TEST_F(Cli, DryRunFindsAClosureFileThatIsNone) {
  std::string poses;
  for (int i = 0; i < 20; ++i) poses += fmt::format("{} {} 0 0 0 0 0 1\n", i, i * i);
  folder_.file("e.txt", poses);
  folder_.file("loops.txt", "not a closure\n");
  const std::string with = "dataset: trajectory, estimate: e.txt, reference: e.txt, closures: ";
  const CommandResult result = dry_run(with + "{source: file, file: loops.txt}");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("loops.txt:1: has 3 columns, expected 9 or 11"));
  EXPECT_EQ(dry_run(with + "{source: none}").exit_code, 0);
}

TEST_F(Cli, RejectsThreeThousandMillionCellsWithoutBuildingThem) {
  folder_.file("c.yaml",
               "datasets:\n  - {dataset: simulated, sweep: {keyframes: {from: 20, to: 1019, "
               "steps: 1000}}}\n"
               "methods: [{method: uniform, sweep: {weights: [index, time]}, label: u}, raw]\n"
               "metrics: [ate]\nrepeats: 1000000\n");
  for (const char* more : {" --dry-run", " --only nothing"}) {
    const CommandResult result = run("run c.yaml" + std::string(more));
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err,
              "loopbench: c.yaml: 1000 datasets, 3 methods and 1000000 repeats of seeded datasets "
              "give 3000000000 cells, expected at most 1000000; 'limits: {cells: N}' accepts "
              "more\n");
  }
}

TEST_F(Cli, DryRunFindsAGraphAndAFolderOfImagesThatAreNone) {
  folder_.file("g.g2o", "VERTEX_SE2 0 0 0\n");
  EXPECT_EQ(dry_run("dataset: pose_graph, path: g.g2o").exit_code, 2);
  std::filesystem::create_directory(folder_.path() / "images");
  const CommandResult result = dry_run("dataset: rgbd, path: images");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err, "");
}

TEST_F(Cli, RunLeavesStoreAndTables) {
  folder_.file("c.yaml", kConfig);
  const CommandResult result = successful_command("run c.yaml", folder_);
  EXPECT_EQ(result.err, "");                              // no progress bar into a pipe
  EXPECT_EQ(result.out.find('\033'), std::string::npos);  // no colour either
  EXPECT_EQ(result.out.find("### ate [m], dense, rmse by sequence\n"), 0u) << result.out;
  EXPECT_NE(result.out.find(" gain [%] |"), std::string::npos);
  EXPECT_NE(result.out.find("next:\n  loopbench table results/c "), std::string::npos);
  const std::string tables = read_all(folder_.path() / "results/c/table.md");
  EXPECT_NE(tables.find("### b, dense"), std::string::npos) << tables;
  EXPECT_NE(tables.find("uniform: declined: "), std::string::npos);  // no closures
  for (const char* name : {"results.sqlite", "table.md", "table.csv", "rows.csv"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "results/c" / name)) << name;
  }
  const CommandResult table = successful_command(
      "table results/c --where metric=ate --where sequence=b --columns times,axis", folder_);
  EXPECT_NE(table.out.find("| raw "), std::string::npos) << table.out;
}

TEST_F(Cli, AnUndefinedScoreIsTellingAndFails) {
  folder_.file("c.yaml",
               "datasets: [{dataset: simulated, path: line}]\nmethods: [raw]\nmetrics: [ate]\n");
  const CommandResult result = run("run c.yaml");
  EXPECT_EQ(result.exit_code, 1);  // a straight line has no unique alignment
  EXPECT_NE(result.out.find("- raw: ate failed: alignment se3: "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("1 of 1 cells done, 1 failed"), std::string::npos) << result.out;
}

TEST_F(Cli, SeveralProtocolsSplitTheTables) {
  folder_.file("c.yaml", std::string(kConfig) + "protocol: [loopbench, {base: evo, align: se3}]\n");
  const CommandResult result = successful_command("run c.yaml", folder_);
  const std::string tables = read_all(folder_.path() / "results/c/table.md");
  EXPECT_NE(tables.find("### b, dense, loopbench\n"), std::string::npos) << tables;
  EXPECT_NE(tables.find("### b, dense, evo (align=se3)\n"), std::string::npos);
  EXPECT_THAT(result.out, HasSubstr("protocol: loopbench [3], evo (align=se3) [26d0953]"));
  const CommandResult rows = run("export results/c");
  EXPECT_THAT(rows.out, HasSubstr(",evo (align=se3),26d0953,keyframes,ate,"));
  const CommandResult one =
      successful_command("table results/c --where protocol=loopbench", folder_);
  EXPECT_EQ(one.out.substr(0, one.out.find("<!-- source")).find("evo"), std::string::npos)
      << one.out;
}

TEST_F(Cli, OnlyRunsWhatMatches) {
  folder_.file("c.yaml", kConfig);
  const CommandResult result =
      successful_command("run c.yaml --only 'b / (raw|cubic)' --out here", folder_);
  EXPECT_NE(result.out.find("2 of 2 cells done"), std::string::npos) << result.out;
  EXPECT_EQ(run("run c.yaml --only nothing").exit_code, 2);
}

TEST_F(Cli, MissingDataEndsBeforeAnythingIsWritten) {
  folder_.file("c.yaml",
               "datasets:\n  - {dataset: trajectory, estimate: no/such.txt}\n"
               "methods: [raw]\nmetrics: [ate]\n");
  const CommandResult result = run("run c.yaml");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("no/such.txt: no such file"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "results"));
  EXPECT_EQ(run("run c.yaml --data nowhere").exit_code, 2);
  EXPECT_EQ(run("run nowhere.yaml").exit_code, 2);
  EXPECT_EQ(run("run .").exit_code, 2);
  EXPECT_EQ(run("table nowhere").exit_code, 2);
}

TEST_F(Cli, EveryBadFileIsOneClearErrorAndExitCodeTwo) {
  const std::filesystem::path bad = LOOPBENCH_TEST_DATA "/bad";
  std::ifstream manifest(bad / "manifest.txt");
  int seen = 0;
  for (std::string line; std::getline(manifest, line);) {
    if (line.starts_with('#')) continue;
    const std::size_t tab = line.find('\t');
    const std::string file = (bad / line.substr(0, tab)).string();
    const std::string message = line.substr(line.find('\t', tab + 1) + 1);
    const bool is_graph = line.compare(tab + 1, 3, "g2o") == 0;
    // `eval` accepts positions, an estimate of a config needs rotations.
    const bool is_run = is_graph || message.find("without rotation") != std::string::npos ||
                        message.find("quaternion is zero") != std::string::npos;
    folder_.file("bad.yaml",
                 std::string("datasets: [{dataset: ") +
                     (is_graph ? "pose_graph, path: '" : "trajectory, estimate: '") + file +
                     "'}]\nmethods: [raw]\nmetrics: [ate]\n");
    const CommandResult result =
        run(is_run ? "run bad.yaml" : "eval '" LOOPBENCH_TEST_DATA "/good/tum.txt' '" + file + "'");
    EXPECT_EQ(result.exit_code, 2) << file;
    EXPECT_EQ(result.out, "") << file;
    EXPECT_EQ(result.err, "loopbench: " + file + message + "\n");
    ++seen;
  }
  EXPECT_GE(seen, 25);
}

TEST_F(Cli, ListKnowsEverythingThatCanBeNamed) {
  const CommandResult all = run("list");
  EXPECT_EQ(all.exit_code, 0);
  for (const char* name : {"simulated", "trajectory", "pose_graph", "uniform", "dm_m8", "rpe"}) {
    EXPECT_NE(all.out.find(std::string("\n") + name), std::string::npos) << name;
  }
  const CommandResult json = run("list methods --json");
  EXPECT_EQ(json.out.rfind("{\n  \"methods\": [", 0), 0u) << json.out.substr(0, 80);
  const CommandResult protocols = run("list protocols");
  for (const char* name :
       {"loopbench ", "evo ", "tum ", "rpg ", "rpg-fixed ", "kitti ", "hilti "}) {
    EXPECT_NE(("\n" + protocols.out).find(std::string("\n") + name), std::string::npos) << name;
  }
  const CommandResult one = run("list smoothing_spline");
  EXPECT_EQ(one.out.rfind("smoothing_spline ", 0), 0u) << one.out.substr(0, 80);
  EXPECT_EQ(one.out.find("\npose_graph"), std::string::npos);
  EXPECT_NE(one.out.find("    criterion = "), std::string::npos);
  const CommandResult slip = run("list method");
  EXPECT_EQ(slip.exit_code, 2);
  EXPECT_NE(slip.err.find("did you mean 'methods'?"), std::string::npos);
  EXPECT_THAT(run("list smoothing_splin").err, HasSubstr("did you mean 'smoothing_spline'?"));
}

}  // namespace
}  // namespace loopbench::cli_test
