/// Paths, anchors and collected errors in configs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "datasets/core/error.hpp"
#include "harness/config/paths.hpp"
#include "tests/support/command.hpp"

namespace loopbench::config_paths_test {

using namespace harness;

namespace {

using Texts = std::vector<std::string>;

TEST(Paths, ReplaceHomeAndVariables) {
  setenv("LOOPBENCH_TEST_A", "/a b", 1);
  const std::string home = std::getenv("HOME") == nullptr ? "" : std::getenv("HOME");
  if (!home.empty()) {
    EXPECT_EQ(expanded_path("~/x"), home + "/x");
  }
  EXPECT_EQ(expanded_path("$LOOPBENCH_TEST_A/x"), "/a b/x");
  EXPECT_EQ(expanded_path("x/${LOOPBENCH_TEST_A}y"), "x//a by");
  EXPECT_EQ(expanded_path("a~/$/${"), "a~/$/${");
  EXPECT_THROW(expanded_path("$LOOPBENCH_NO_SUCH"), InputError);
}

TEST(Paths, WildcardsStandForTheSameTexts) {
  EXPECT_EQ(wildcard_texts("runs/*/est_?.txt", "runs/a b/est_2.txt"), (Texts{"a b", "2"}));
  EXPECT_EQ(wildcard_texts("*.txt", "a/b.txt"), Texts{});
  EXPECT_EQ(wildcard_texts("r[0-3]*", "r2x"), (Texts{"2", "x"}));
  EXPECT_EQ(wildcard_texts("r[!0-3]", "r2"), Texts{});
  EXPECT_EQ(with_wildcard_texts("truth/*_[0-9].txt", {"a", "2"}), "truth/a_2.txt");
  EXPECT_EQ(with_wildcard_texts("truth/*.txt", {"a", "2"}), "");
}

class ConfigPaths : public testing::Test {
 protected:
  CommandResult dry_run(const std::string& config, const std::string& more = "") {
    folder_.file("c.yaml", config);
    return loopbench_command("run c.yaml --dry-run" + more, folder_);
  }
  std::string poses_ = "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 0 1 0 0 0 0 1\n3 0 0 1 0 0 0 1\n";
  TemporaryFolder folder_;
};

TEST_F(ConfigPaths, APatternIsOneDatasetPerFile) {
  for (const char* name : {"est/b.txt", "est/a.txt", "truth/a.txt", "truth/b.txt"}) {
    folder_.file(name, poses_);
  }
  const std::string rest = "methods: [raw]\nmetrics: [ate]\n";
  const CommandResult result = dry_run(
      "datasets:\n  - {dataset: trajectory, label: my, estimate: 'est/*.txt', reference: "
      "'truth/*.txt', closures: {source: none}}\n" +
      rest);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "    0  my (a) / raw\n    1  my (b) / raw\n2 cells, 1 metric each\n");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "results")) << "nothing is run";
  EXPECT_EQ(dry_run("datasets: [{dataset: trajectory, estimate: 'no/*.txt'}]\n" + rest).err,
            "loopbench: c.yaml:1: estimate: no file matches no/*.txt\n");
  EXPECT_EQ(dry_run("datasets:\n  - dataset: trajectory\n    estimate: 'est/*.txt'\n"
                    "    reference: '*/*.txt'\n" +
                    rest)
                .err,
            "loopbench: c.yaml:4: reference: expected as many wildcards as in estimate\n");
  EXPECT_EQ(
      dry_run("datasets: [{dataset: trajectory, estimate: $LOOPBENCH_NO_SUCH/a}]\n" + rest).err,
      "loopbench: c.yaml:1: estimate: the environment variable LOOPBENCH_NO_SUCH is not set\n");
  // In the data folder, and a file with brackets in its name.
  folder_.file("data/x[1].txt", poses_);
  const std::string own = "datasets: [{dataset: trajectory, label: x, estimate: ";
  EXPECT_EQ(dry_run(own + "'x*.txt'}]\n" + rest, " --data data").out.substr(0, 20),
            "    0  x ([1]) / raw");
  EXPECT_EQ(dry_run(own + "'x[1].txt'}]\n" + rest, " --data data").out.substr(0, 16),
            "    0  x / raw\n1");
}

TEST_F(ConfigPaths, AnchorsHaveAPlaceAtTopLevel) {
  const CommandResult result = dry_run(
      "base: &base {dataset: simulated, path: office}\n"
      "more: &more [raw, uniform]\n"
      "datasets:\n  - {<<: *base, label: a}\n  - {<<: *base, label: b, path: room}\n"
      "methods: *more\nmetrics: [ate, axis_error]\n");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out,
            "    0  a / raw\n    1  a / uniform\n    2  b / raw\n    3  b / uniform\n"
            "4 cells, 2 metrics each\n");
  EXPECT_EQ(dry_run("base: {dataset: simulated}\ndatasets: [simulated]\nmethods: [raw]\n"
                    "metrics: [ate]\n")
                .err.find("loopbench: c.yaml:1: no setting is named 'base'"),
            0u);
  EXPECT_EQ(dry_run("base: &b [raw]\ndatasets: [{<<: *b}]\nmethods: [raw]\nmetrics: [ate]\n").err,
            "loopbench: c.yaml:2: <<: expected an alias of a map, or a list of them\n");
}

TEST_F(ConfigPaths, UpToTenErrorsAreReportedAtOnce) {
  const CommandResult result = dry_run(
      "datasets:\n  - simulatd\n  - {dataset: simulated, path: {}}\n"
      "methods: [raw, unifrom]\nmetrics: [aet]\nrepeats: none\nrepeat: 1\n");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err,
            "loopbench: c.yaml:7: no setting is named 'repeat'; did you mean 'repeats'?\n"
            "loopbench: c.yaml:2: no dataset is named 'simulatd'; did you mean 'simulated'?\n"
            "loopbench: c.yaml:3: path: has no value\n"
            "loopbench: c.yaml:4: no method is named 'unifrom'; did you mean 'uniform'?\n"
            "loopbench: c.yaml:5: no metric is named 'aet'; did you mean 'ate'?\n"
            "loopbench: c.yaml:6: repeats: expected a whole number, 1 to 1000000\n");
  std::string many = "datasets: [simulated]\nmetrics: [ate]\nmethods:\n";
  for (int i = 0; i < 20; ++i) many += "  - unifrom" + std::to_string(i) + "\n";
  const std::string err = dry_run(many).err;
  EXPECT_EQ(std::ranges::count(err, '\n'), 11) << err;
  EXPECT_NE(err.find("\nloopbench: c.yaml: reading stopped after ten errors\n"), std::string::npos);
}

TEST_F(ConfigPaths, ATabIsNamed) {
  EXPECT_EQ(dry_run("datasets:\n\t- simulated\nmethods: [raw]\nmetrics: [ate]\n").err,
            "loopbench: c.yaml:2: is indented with a tab; YAML accepts only spaces\n");
}

}  // namespace
}  // namespace loopbench::config_paths_test
