/// Every shipped config: always checked, and run if its data is available.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

#include "tests/support/command.hpp"

namespace loopbench {
namespace {

std::vector<std::string> shipped() {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(LOOPBENCH_CONFIGS)) {
    if (entry.path().extension() == ".yaml") out.push_back(entry.path().stem().string());
  }
  std::ranges::sort(out);
  return out;
}

class ShippedConfig : public testing::TestWithParam<std::string> {
 protected:
  CommandResult run(const std::string& more) {
    return loopbench_command("run '" LOOPBENCH_CONFIGS "/" + GetParam() + ".yaml' " + more,
                             folder_);
  }
  TemporaryFolder folder_;
};

TEST_P(ShippedConfig, Checks) {
  const CommandResult result = run("--dry-run");
  if (result.err.find("no such file (looked in") != std::string::npos) {
    EXPECT_NE(result.out.find(" cells, "), std::string::npos) << result.out;
    GTEST_SKIP() << "its data is absent; set LOOPBENCH_DATA: " << result.err;
  }
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

// With one repeat: the others differ only in their seed, and take minutes under a sanitizer.
TEST_P(ShippedConfig, RunsWithoutAFailedCell) {
  const std::filesystem::path configs = folder_.path() / "configs";
  std::filesystem::copy(LOOPBENCH_CONFIGS, configs, std::filesystem::copy_options::recursive);
  const std::string name = "configs/" + GetParam() + ".yaml";
  std::ostringstream text;
  text << std::ifstream(folder_.path() / name).rdbuf();
  folder_.file(name,
               std::regex_replace(text.str(), std::regex("\\brepeats: [0-9]+"), "repeats: 1"));
  const CommandResult result = loopbench_command("run " + name + " --out out", folder_);
  if (result.err.find("no such file (looked in") != std::string::npos) {
    GTEST_SKIP() << "its data is absent; set LOOPBENCH_DATA: " << result.err;
  }
  EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
  EXPECT_NE(result.out.find(" 0 failed;"), std::string::npos) << result.out;
  const std::string baseline = LOOPBENCH_CONFIGS "/../results/reference/" + GetParam() + ".json";
  if (!std::filesystem::exists(baseline)) return;
  const CommandResult checked =
      loopbench_command("check out --part --baseline '" + baseline + "'", folder_);
  EXPECT_EQ(checked.exit_code, 0) << checked.err << checked.out;
}

INSTANTIATE_TEST_SUITE_P(Configs,
                         ShippedConfig,
                         testing::ValuesIn(shipped()),
                         [](const auto& chosen) { return chosen.param; });

}  // namespace
}  // namespace loopbench
