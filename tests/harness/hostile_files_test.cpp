/// Links, pipes and devices in place of files, closed streams, and texts that steer programs.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <thread>

#include "datasets/core/error.hpp"
#include "harness/base/hash.hpp"
#include "harness/base/printable.hpp"
#include "harness/base/write_file.hpp"
#include "harness/tables/record_csv.hpp"
#include "harness/tables/table.hpp"
#include "tests/support/command.hpp"

namespace loopbench::hostile_files_test {

using namespace harness;

namespace {

namespace fs = std::filesystem;

std::size_t files_in(const TemporaryFolder& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
}

TEST(WriteResult, ReplacesLinksPipesAndDevicesInAFolderOfResults) {
  const TemporaryFolder folder;
  const fs::path mine = folder.file("mine", "precious");
  fs::create_symlink(mine, folder.path() / "link");
  fs::create_symlink("/dev/full", folder.path() / "device");
  fs::create_symlink(folder.path() / "absent", folder.path() / "dangling");
  ASSERT_EQ(mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
  for (const char* name : {"link", "device", "dangling", "pipe"}) {
    write_result(folder.path() / name, "new");
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder.path() / name))) << name;
    EXPECT_EQ(read_all(folder.path() / name), "new") << name;
  }
  EXPECT_EQ(read_all(mine), "precious");
  EXPECT_FALSE(fs::exists(folder.path() / "absent"));
  EXPECT_EQ(files_in(folder), 5u);
}

TEST(HashOfFile, ReadsInBlocksAndNothingButRegularFiles) {
  const TemporaryFolder folder;
  for (const std::size_t size : {std::size_t{0},
                                 std::size_t{15},
                                 std::size_t{16},
                                 (std::size_t{1} << 20) - 1,
                                 std::size_t{1} << 20,
                                 (std::size_t{1} << 20) + 17}) {
    std::string text(size, 'x');
    for (std::size_t i = 0; i < size; i += 7) text[i] = static_cast<char>(i);
    EXPECT_EQ(hash_of_file(folder.file("f", text)), hash_of(text)) << size;
  }
  EXPECT_THROW(hash_of_file("/dev/zero"), InputError);
  EXPECT_THROW(hash_of_file(folder.path()), InputError);
  ASSERT_EQ(mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(hash_of_file(folder.path() / "pipe"), InputError);
}

TEST(HashOfFile, SurvivesAFileThatIsTruncatedMeanwhile) {
  const TemporaryFolder folder;
  const fs::path file = folder.file("f", std::string(std::size_t{8} << 20, 'x'));
  std::atomic<bool> done = false;
  std::thread truncating([&] {
    for (bool is_short = false; !done; is_short = !is_short) {
      fs::resize_file(file, is_short ? std::size_t{8} << 20 : 0);
    }
  });
  for (int i = 0; i < 20; ++i) hash_of_file(file);  // SIGBUS if the file were mapped
  done = true;
  truncating.join();
}

TEST(Csv, EscapesControlCharactersAndFormulas) {
  EXPECT_EQ(quoted("\x1b[31m"), "\\x1b[31m");
  EXPECT_EQ(quoted("\xff"), "\\xff");
  EXPECT_EQ(quoted("=cmd|' /C calc'!A0"), "'=cmd|' /C calc'!A0");
  EXPECT_EQ(quoted("=1,2"), "\"'=1,2\"");
  EXPECT_EQ(quoted("@SUM(A1)"), "'@SUM(A1)");
  EXPECT_EQ(quoted("-2+3+cmd|'x'!A0"), "'-2+3+cmd|'x'!A0");
  EXPECT_EQ(quoted("+A1"), "'+A1");
  for (const char* plain : {"", "-", "-1.5e-3", "+2", "-12 %", "-0.1 m/s", "a=1", "uniform"}) {
    EXPECT_EQ(quoted(plain), plain);
  }
}

TEST(Tables, PrintNothingButUtf8WithoutControlCharacters) {
  const std::string bad = "a\x1b[31m\xff\xc2\x9b";
  Table view{bad, {bad, bad}, {{{bad, Mark::none}, {bad, Mark::none}}}, {bad}};
  const auto is_plain = [](std::string text) {
    std::erase(text, '\n');
    return first_unprintable(text) == text.size();
  };
  EXPECT_TRUE(is_plain(markdown(view)));
  EXPECT_TRUE(is_plain(latex(view)));
  EXPECT_TRUE(is_plain(terminal(view)));
  EXPECT_TRUE(is_plain(text_csv(view)));
}

class HostileFiles : public testing::Test {
 protected:
  /// With streams redirected by `shell`; err is the file "err".
  CommandResult run(const std::string& arguments, const std::string& shell) {
    const std::string line = "cd '" + folder_.path().string() + "' && '" LOOPBENCH_BINARY "' " +
                             arguments + " 2>err " + shell;
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, "", read_all(folder_.path() / "err")};
  }
  TemporaryFolder folder_;
  const fs::path poses_ =
      folder_.file("a.txt", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 0 1 0 0 0 0 1\n3 0 0 1 0 0 0 1\n");
  const fs::path config_ = folder_.file(
      "s.yaml",
      "datasets: [{dataset: simulated, keyframes: 40}]\nmethods: [raw]\nmetrics: [ate]\n");
};

TEST_F(HostileFiles, ClosedStandardStreamsCrashNothing) {
  EXPECT_EQ(run("eval a.txt a.txt", "2>&- >/dev/null").exit_code, 0);
  EXPECT_EQ(run("eval absent.txt a.txt", "<&- >&- 2>&-").exit_code, 2);
  EXPECT_EQ(run("eval a.txt a.txt", "<&- >&- 2>&-").exit_code, 2) << "the result cannot be printed";
  EXPECT_EQ(run("eval absent.txt a.txt", "2>/dev/full").exit_code, 2);
  EXPECT_EQ(run("run s.yaml --out closed", "<&- >&- 2>&-").exit_code, 2);
  EXPECT_EQ(run("run s.yaml --out closed", ">out").exit_code, 0);
  EXPECT_NE(read_all(folder_.path() / "out").find("1 of 1 cells done (1 of them in earlier runs)"),
            std::string::npos);
}

TEST_F(HostileFiles, NoCommandWaitsForAPipeInPlaceOfAStore) {
  ASSERT_EQ(mkfifo((folder_.path() / "pipe").c_str(), 0600), 0);
  for (const char* arguments : {"table pipe", "report pipe", "check pipe --baseline b"}) {
    EXPECT_EQ(run(arguments, ">out").exit_code, 2) << arguments;
  }
  EXPECT_EQ(read_all(folder_.path() / "err").find("loopbench: "), 0u);
  run("table pipe", ">out");
  EXPECT_EQ(read_all(folder_.path() / "err"),
            "loopbench: pipe: is not a regular file, expected a store of results\n");
}

TEST_F(HostileFiles, AStoreIsNotWrittenThroughALink) {
  fs::create_directory(folder_.path() / "l");
  folder_.file("empty", "");
  for (const char* target : {"absent", "empty"}) {
    for (const char* part : {"results.sqlite", "results.sqlite-wal"}) {
      fs::create_symlink(folder_.path() / target, folder_.path() / "l" / part);
      EXPECT_EQ(run("run s.yaml --out l", ">/dev/null").exit_code, 2) << target;
      EXPECT_EQ(read_all(folder_.path() / "err"),
                std::string("loopbench: l/") + part + ": is a symbolic link, expected a store of " +
                    "results; remove it, or use another --out\n");
      EXPECT_EQ(run("run s.yaml --out l --fresh", ">/dev/null").exit_code, 2) << target;
      fs::remove(folder_.path() / "l" / part);
    }
  }
  EXPECT_FALSE(fs::exists(folder_.path() / "absent"));
  EXPECT_EQ(fs::file_size(folder_.path() / "empty"), 0u);
}

TEST_F(HostileFiles, LinksInAFolderOfResultsAreReplacedAndNotFollowed) {
  const fs::path mine = folder_.file("mine", "precious");
  fs::create_directory(folder_.path() / "r");
  const auto names = {"table.md", "table.csv", "rows.csv", "provenance.json"};
  for (const char* name : names) fs::create_symlink(mine, folder_.path() / "r" / name);
  EXPECT_EQ(run("run s.yaml --out r", ">/dev/null").exit_code, 0);
  for (const char* name : names) EXPECT_FALSE(fs::is_symlink(folder_.path() / "r" / name)) << name;
  fs::remove(folder_.path() / "r/table.md");
  fs::create_symlink(mine, folder_.path() / "r/table.md");
  EXPECT_EQ(run("run s.yaml --out r", ">out").exit_code, 0);
  EXPECT_EQ(read_all(folder_.path() / "out").find("precious"), std::string::npos);
  EXPECT_FALSE(fs::is_symlink(folder_.path() / "r/table.md"));
  fs::create_symlink(mine, folder_.path() / "t.provenance.json");
  EXPECT_EQ(run("table r --format csv -o t.csv", ">out").exit_code, 0);
  EXPECT_EQ(read_all(mine), "precious");
}

}  // namespace
}  // namespace loopbench::hostile_files_test
