/// The pages of results/paper are what `reproduce` writes, and prose repeats their numbers only.
#include <gtest/gtest.h>

#include <cctype>
#include <set>

#include "tests/support/command.hpp"

namespace loopbench::paper_page_test {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = fs::path(LOOPBENCH_CONFIGS).parent_path();

/// Runs reproduce and compares every page it writes with the stored one of that name.
void expect_stored(const std::string& arguments, const fs::path& stored) {
  if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "gnuplot is absent";
  const TemporaryFolder folder;
  const CommandResult result = loopbench_command("reproduce " + arguments + " --out page", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::size_t pages = 0;
  for (const auto& entry : fs::directory_iterator(folder.path() / "page")) {
    if (entry.path().extension() != ".md") continue;
    ++pages;
    const std::string name = entry.path().filename().string();
    EXPECT_EQ(read_all(entry.path()), read_all(stored / name))
        << name << " is not what `loopbench reproduce " << arguments << "` writes; run it and "
        << "state on the page what changed";
  }
  EXPECT_GT(pages, 0u);
}

TEST(PaperPage, OfTheStandInIsWhatReproduceWrites) {
  const fs::path stored = kRoot / "tests/data/paper_stand_in";
  expect_stored("'" + (stored / "paper_tables_stand_in.yaml").string() + "'", stored);
}

// The other pages take longer: results/paper/README.md has the command for all.
TEST(PaperPage, OfTheArticleIsWhatReproduceWrites) {
  const char* root = std::getenv("LOOPBENCH_DATA");
  if (root == nullptr) GTEST_SKIP() << "LOOPBENCH_DATA is not set: no real trajectories";
  if (!fs::exists(fs::path(root) / "tum_rgbd")) GTEST_SKIP() << "no tum_rgbd";
  std::string configs;
  for (const char* name : {"fr1", "fr1_mono", "fr3", "fr3_mono", "readings_fr1", "readings_fr3"}) {
    configs += std::string(" '" LOOPBENCH_CONFIGS "/paper_tables_") + name + ".yaml'";
  }
  expect_stored(configs, kRoot / "results/paper");
}

/// All numbers with decimals, such as 0.0365.
std::set<std::string> decimals(const std::string& text) {
  std::set<std::string> out;
  const auto is_part = [](char c) {
    return std::isdigit(static_cast<unsigned char>(c)) || c == '.';
  };
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = begin;
    while (end < text.size() && is_part(text[end])) ++end;
    std::string word = text.substr(begin, end - begin);
    while (word.ends_with('.')) word.pop_back();
    if (word.find('.') != std::string::npos) out.insert(word);
    begin = end + 1;
  }
  return out;
}

TEST(PaperPage, QuotesOnlyNumbersOfTheTables) {
  const fs::path folder = kRoot / "results/paper";
  std::set<std::string> tables;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename() != "README.md" && entry.path().extension() == ".md")
      tables.merge(decimals(read_all(entry.path())));
  }
  for (const std::string& number : decimals(read_all(folder / "README.md"))) {
    EXPECT_TRUE(tables.contains(number)) << number << " is in no table of results/paper";
  }
}

}  // namespace
}  // namespace loopbench::paper_page_test
