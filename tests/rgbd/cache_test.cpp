// Cache entries are read only under the name and by the build that they were written for.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>

#include "datasets/rgbd/stage_cache.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::cache_test {

using namespace rgbd;

namespace {

namespace fs = std::filesystem;

class Cache : public testing::Test {
 protected:
  CacheEntry entry(const std::string& name, const std::string& build = "one") const {
    return {folder_.path(), name, build};
  }
  TemporaryFolder folder_;
};

TEST_F(Cache, ReturnsWhatWasStored) {
  EXPECT_EQ(load_cached(entry("track-01")), std::nullopt);
  store_cached(entry("track-01"), "first");
  store_cached(entry("features-02/000007"), "");
  EXPECT_EQ(load_cached(entry("track-01")), "first");
  EXPECT_EQ(load_cached(entry("features-02/000007")), "");
}

TEST_F(Cache, NoticesExchangedEntries) {
  store_cached(entry("track-01"), "seed one");
  store_cached(entry("track-02"), "seed two");
  fs::rename(folder_.path() / "track-01", folder_.path() / "held");
  fs::rename(folder_.path() / "track-02", folder_.path() / "track-01");
  fs::rename(folder_.path() / "held", folder_.path() / "track-02");
  EXPECT_EQ(load_cached(entry("track-01")), std::nullopt);
  EXPECT_EQ(load_cached(entry("track-02")), std::nullopt);
}

TEST_F(Cache, NoticesEntriesOfAnotherBuild) {
  store_cached(entry("track-01", "one"), "old code");
  EXPECT_EQ(load_cached(entry("track-01", "two")), std::nullopt);
  EXPECT_EQ(load_cached(entry("track-01", "one")), "old code");
}

TEST_F(Cache, ReadsNothingButRegularFiles) {
  ASSERT_EQ(mkfifo((folder_.path() / "track-01").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder_.path() / "track-02");
  fs::create_directory(folder_.path() / "track-03");
  for (const char* name : {"track-01", "track-02", "track-03"}) {
    EXPECT_EQ(load_cached(entry(name)), std::nullopt) << name;
  }
}

TEST_F(Cache, WritesThroughNoLinkAndLeavesNoTemporaryFiles) {
  const fs::path mine = folder_.file("mine", "precious");
  fs::create_symlink(mine, folder_.path() / "track-01");
  store_cached(entry("track-01"), "bytes");
  EXPECT_EQ(load_cached(entry("track-01")), "bytes");
  std::ifstream in(mine);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "precious");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 2);
}

}  // namespace
}  // namespace loopbench::cache_test
