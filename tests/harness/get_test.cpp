/// Downloads from a local server: hashes, pins, continued downloads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "datasets/core/error.hpp"
#include "harness/commands/download.hpp"
#include "tests/support/command.hpp"
#include "tests/support/file_server.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::get_test {

using namespace harness;

namespace {

TEST(PublicFiles, AreCompleteAndHaveDistinctNames) {
  std::vector<std::string> names;
  for (const PublicFile& each : public_files()) {
    EXPECT_EQ(std::ranges::count(names, each.name), 0) << each.name;
    names.push_back(each.name);
    EXPECT_FALSE(each.licence.empty() || each.summary.empty()) << each.name;
    EXPECT_TRUE(each.url.starts_with("https://")) << each.url;
    EXPECT_EQ(each.sha256.size(), 64u) << each.name;
    EXPECT_TRUE(each.file.is_relative()) << each.file;
  }
  EXPECT_GE(names.size(), 5u);
}

/// The data folder holds copies of some of them, below the same names.
TEST(PublicFiles, HaveTheHashesOfTheirCopies) {
  const char* root = std::getenv("LOOPBENCH_DATA");
  if (root == nullptr) GTEST_SKIP() << "LOOPBENCH_DATA is not set: no copies";
  const std::filesystem::path data = root;
  int found = 0;
  for (const PublicFile& each : public_files()) {
    if (!std::filesystem::exists(data / each.file)) continue;
    EXPECT_EQ(sha256_of_file(data / each.file), each.sha256) << each.name;
    ++found;
  }
  EXPECT_GE(found, 9);
}

class Get : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v curl >/dev/null 2>&1") != 0) GTEST_SKIP() << "needs curl";
  }
  PublicFile wanted(const std::string& hash) const {
    return {"a", server_.url(), "none", hash, "below/a.bin", "test"};
  }
  Fetched get(const std::string& hash) { return fetch(wanted(hash), folder_.path()); }
  std::string why_not(const std::string& hash) {
    return refusal_of([&] { get(hash); });
  }

  const std::string content_ = std::string(100'000, 'x') + "end";
  TemporaryFolder folder_;
  const std::string hash_ = sha256_of_file(folder_.file("content", content_));
  const std::filesystem::path file_ = folder_.path() / "below/a.bin";
  FileServer server_{content_};
};

TEST_F(Get, DownloadsAndVerifies) {
  EXPECT_EQ(get(hash_), Fetched::downloaded);
  EXPECT_EQ(read_all(file_), content_);
  EXPECT_EQ(get(hash_), Fetched::present);
  EXPECT_EQ(server_.starts().size(), 1u);
  folder_.file("below/a.bin", "damaged");
  EXPECT_NE(why_not(hash_).find("remove the file to download it again"), std::string::npos);
  EXPECT_EQ(read_all(file_), "damaged");
}

TEST_F(Get, RejectsChangedContent) {
  server_.set_content("other");
  EXPECT_NE(why_not(hash_).find("the content has changed and was rejected"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(file_));
  EXPECT_FALSE(std::filesystem::exists(file_.string() + ".part"));
}

TEST_F(Get, ContinuesAnInterruptedDownload) {
  server_.cut_after = 60'000;
  EXPECT_NE(why_not(hash_).find("run the command again to continue"), std::string::npos);
  EXPECT_EQ(std::filesystem::file_size(file_.string() + ".part"), 60'000u);
  server_.cut_after = 0;
  EXPECT_EQ(get(hash_), Fetched::downloaded);
  EXPECT_EQ(server_.starts(), (std::vector<std::size_t>{0, 60'000}));
  EXPECT_EQ(read_all(file_), content_);
}

TEST_F(Get, StartsAgainWithoutRanges) {
  server_.knows_ranges = false;
  std::filesystem::create_directories(file_.parent_path());
  folder_.file("below/a.bin.part", content_.substr(0, 1000));
  EXPECT_EQ(get(hash_), Fetched::downloaded);
  EXPECT_EQ(read_all(file_), content_);
}

TEST_F(Get, AcceptsAPartThatIsComplete) {
  std::filesystem::create_directories(file_.parent_path());
  folder_.file("below/a.bin.part", content_);
  EXPECT_EQ(get(hash_), Fetched::downloaded);
}

TEST(GetCommand, ListsSequencesAndSuggestsNames) {
  const TemporaryFolder folder;
  EXPECT_NE(loopbench_command("get", folder).out.find("tum_fr1_room "), std::string::npos);
  EXPECT_EQ(loopbench_command("get kitti_01", folder).err,
            "loopbench: no sequence is named 'kitti_01'; did you mean 'kitti_00'?\n");
  EXPECT_EQ(loopbench_command("get mulran", folder).err,
            "loopbench: mulran: has to be downloaded by hand from "
            "https://sites.google.com/view/mulran-pr; its global_pose.csv is read as it is\n");
}

}  // namespace
}  // namespace loopbench::get_test
