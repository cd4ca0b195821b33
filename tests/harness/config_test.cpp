/// Every shipped config: always checked, and run if its data is available.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <sstream>

#include "tests/support/command.hpp"

namespace loopbench::config_test {
namespace {

const std::filesystem::path kConfigs = LOOPBENCH_CONFIGS;
const std::filesystem::path kResults = kConfigs.parent_path() / "results";
const std::filesystem::path kMethodConfigs = kResults / "methods/configs";

std::vector<std::string> shipped() {
  std::vector<std::string> out;
  for (const auto& folder : {kConfigs, kMethodConfigs}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ".yaml") out.push_back(entry.path().stem().string());
    }
  }
  std::ranges::sort(out);
  return out;
}

/// The config of that name; those of the results need the article's readings.
std::filesystem::path file_of(const std::string& name) {
  const std::filesystem::path file = kConfigs / (name + ".yaml");
  return std::filesystem::exists(file) ? file : kMethodConfigs / (name + ".yaml");
}
std::string plugin_option(const std::string& name) {
  return file_of(name).parent_path() == kConfigs ? "" : " --plugin '" LOOPBENCH_PAPER_PLUGIN "' ";
}

class ShippedConfig : public testing::TestWithParam<std::string> {
 protected:
  CommandResult run(const std::string& more) {
    return loopbench_command(
        "run '" + file_of(GetParam()).string() + "'" + plugin_option(GetParam()) + " " + more,
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
  const bool has_data = std::getenv("LOOPBENCH_DATA") != nullptr;
  if (result.err.find(": no file matches exam/") != std::string::npos) {
    GTEST_SKIP() << "its data are unseen until the exam: " << result.err;
  }
  if (!has_data && result.err.find(": no file matches ") != std::string::npos) {
    GTEST_SKIP() << "its data is absent; set LOOPBENCH_DATA: " << result.err;
  }
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

/// Patterns for --only that together cover every dataset and every method of the plan, and few of
/// their products: dataset d with method d, method m with dataset m (both modulo), and all `raw`
/// cells. A pattern has at most 1000 characters.
std::vector<std::string> every_dataset_and_method(const std::string& plan) {
  std::vector<std::string> datasets, methods;
  std::vector<std::pair<std::size_t, std::size_t>> planned;
  const auto index_of = [](std::vector<std::string>& names, const std::string& name) {
    const auto found = std::ranges::find(names, name);
    const auto index = static_cast<std::size_t>(found - names.begin());
    if (found == names.end()) names.push_back(name);
    return index;
  };
  const std::regex cell(R"( *[0-9]+  (.*) / (.*))");
  std::istringstream lines(plan);
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (!std::regex_match(line, match, cell)) continue;
    planned.emplace_back(index_of(datasets, match[1]), index_of(methods, match[2]));
  }
  std::vector<std::string> out;
  for (const auto& [dataset, method] : planned) {
    if (method != dataset % methods.size() && dataset != method % datasets.size() &&
        methods[method] != "raw") {
      continue;
    }
    // The shell quotes the pattern: any character stands for an apostrophe.
    const std::string name = std::regex_replace(
        "^\\Q" + datasets[dataset] + " / " + methods[method] + "\\E$", std::regex("'"), "\\E.\\Q");
    if (out.empty() || out.back().size() + name.size() > 900) {
      out.push_back(name);
    } else {
      out.back() += "|" + name;
    }
  }
  return out;
}

/// The config's text with one repeat (the others differ in their seed only), and without a baseline
/// also with few updates of short drives: whether its cells run does not depend on their number.
std::string shortened(std::string text, bool has_baseline) {
  text = std::regex_replace(text, std::regex("\\brepeats: [0-9]+"), "repeats: 1");
  if (has_baseline) return text;
  text = std::regex_replace(text, std::regex("\\bmax_updates: [0-9]+"), "max_updates: 3");
  text = std::regex_replace(text, std::regex("\\bkeyframes: 10+\\b"), "keyframes: 200");
  return std::regex_replace(text, std::regex("\\blaps: 10+\\b"), "laps: 2");
}

/// Whether a file or all files of a pattern are missing.
bool lacks_data(const CommandResult& result) {
  return result.err.find("no such file (looked in") != std::string::npos ||
         result.err.find("no file matches") != std::string::npos;
}

// A config with a baseline is run completely and checked against it; other configs run every
// dataset and every method once.
TEST_P(ShippedConfig, RunsWithoutAFailedCell) {
  const std::filesystem::path configs = folder_.path() / "configs";
  std::filesystem::copy(LOOPBENCH_CONFIGS, configs, std::filesystem::copy_options::recursive);
  const std::string name = "configs/" + GetParam() + ".yaml";
  const std::string command = "run " + name + plugin_option(GetParam());
  const std::string baseline = LOOPBENCH_CONFIGS "/../results/reference/" + GetParam() + ".json";
  const bool has_baseline = std::filesystem::exists(baseline);
  folder_.file(name, shortened(read_all(file_of(GetParam())), has_baseline));
  std::vector<std::string> patterns{""};
  if (!has_baseline) {
    const CommandResult plan = loopbench_command(command + " --dry-run", folder_);
    patterns = every_dataset_and_method(plan.out);
    if (lacks_data(plan)) {
      GTEST_SKIP() << "its data is absent; set LOOPBENCH_DATA: " << plan.err;
    }
    ASSERT_FALSE(patterns.empty()) << plan.err << plan.out;
  }
  for (const std::string& only : patterns) {
    const CommandResult result =
        loopbench_command(command + " --out out --only '" + only + "'", folder_);
    if (lacks_data(result)) {
      GTEST_SKIP() << "its data is absent; set LOOPBENCH_DATA: " << result.err;
    }
    EXPECT_EQ(result.exit_code, 0) << only << result.err << result.out;
    EXPECT_NE(result.out.find(" 0 failed;"), std::string::npos) << result.out;
  }
  if (!has_baseline) return;
  const CommandResult checked =
      loopbench_command("check out --part --baseline '" + baseline + "'", folder_);
  EXPECT_EQ(checked.exit_code, 0) << checked.err << checked.out;
}

INSTANTIATE_TEST_SUITE_P(Configs,
                         ShippedConfig,
                         testing::ValuesIn(shipped()),
                         [](const auto& chosen) { return chosen.param; });

}  // namespace
}  // namespace loopbench::config_test
