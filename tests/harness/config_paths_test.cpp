/// Paths in configs.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "datasets/core/error.hpp"
#include "harness/sweep/config/paths.hpp"
#include "tests/support/temporary_folder.hpp"

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

// One pattern for all files of a recording, those of times and of measured positions included.
TEST(Paths, PatternsOfAllFilesOfADatasetStandForTheSameTexts) {
  const TemporaryFolder folder;
  for (const char* name : {"a", "b"}) {
    std::filesystem::create_directory(folder.path() / name);
    folder.file(std::string(name) + "/estimate.txt", "");
  }
  GridPoint point;
  std::vector<OptionInfo> options;
  for (const std::string option :
       {"estimate", "reference", "frames", "times", "closures.file", "anchors.file"}) {
    const std::string text = "*/" + option + ".txt";
    point.settings.push_back({option, Param(text), Place("c.yaml"), text});
    options.push_back(
        {.name = option, .value = std::string(), .help = "", .rule = "", .is_text = true});
  }
  const std::vector<GridPoint> points = expand_paths(point, options, {folder.path()});
  ASSERT_EQ(points.size(), 2u);
  for (const Setting& each : points[1].settings)
    EXPECT_EQ(each.text, "b/" + each.name + ".txt") << each.name;
}

}  // namespace
}  // namespace loopbench::config_paths_test
