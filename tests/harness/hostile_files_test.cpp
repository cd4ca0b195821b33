/// Written files are complete or an error is reported; links, pipes and devices in place of files,
/// and texts that steer programs.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <thread>

#include "datasets/core/error.hpp"
#include "harness/answers/tables/record_csv.hpp"
#include "harness/answers/tables/table.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/text/hash.hpp"
#include "harness/sweep/text/printable.hpp"
#include "tests/support/command.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::hostile_files_test {

using namespace harness;

namespace {

namespace fs = std::filesystem;

std::string why_unwritten(const fs::path& file) {
  return refusal_of<InputError>([&] { write_file(file, "new"); });
}

std::size_t files_in(const TemporaryFolder& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
}

TEST(WriteFile, MakesFoldersAndKeepsTheMode) {
  const TemporaryFolder folder;
  write_file(folder.path() / "a/b", "new");
  EXPECT_EQ(read_all(folder.path() / "a/b"), "new");
  const fs::path mine = folder.file("mine", "old");
  fs::permissions(mine, fs::perms::owner_read | fs::perms::owner_write);
  write_file(mine, "new");
  EXPECT_EQ(read_all(mine), "new");
  EXPECT_EQ(fs::status(mine).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(files_in(folder), 2u);  // no temporary files remain
}

TEST(WriteFile, FollowsLinks) {
  const TemporaryFolder folder;
  folder.file("there", "old");
  fs::create_symlink("there", folder.path() / "link");
  fs::create_symlink("link", folder.path() / "link_to_link");
  fs::create_symlink("made", folder.path() / "dangling");
  write_file(folder.path() / "link_to_link", "new");
  write_file(folder.path() / "dangling", "new");
  EXPECT_EQ(read_all(folder.path() / "there"), "new");
  EXPECT_EQ(read_all(folder.path() / "made"), "new");
  for (const char* link : {"link", "link_to_link", "dangling"}) {
    EXPECT_TRUE(fs::is_symlink(folder.path() / link)) << link;
  }
}

TEST(WriteFile, WritesIntoAPipe) {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::string got;
  std::thread reader([&] { got = read_all(pipe); });
  write_file(pipe, "new");
  reader.join();
  EXPECT_EQ(got, "new");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(WriteFile, RefusesWhatNobodyMayWrite) {
  const TemporaryFolder folder;
  const fs::path file = folder.file("locked", "old");
  fs::permissions(file, fs::perms::owner_read);
  EXPECT_EQ(why_unwritten(file), file.string() + ": cannot be written: is read-only");
  EXPECT_EQ(read_all(file), "old");
  EXPECT_EQ(why_unwritten(folder.path()),
            folder.path().string() + ": cannot be written: is a folder");
  EXPECT_EQ(why_unwritten(file / "below"),
            (file / "below").string() + ": cannot be written: Not a directory");
  EXPECT_EQ(files_in(folder), 1u);
}

TEST(Printable, LeavesNothingThatSteersATerminal) {
  EXPECT_EQ(printable("a b\nc \xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80"),
            "a b\nc \xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80");
  EXPECT_EQ(printable("\x1b[31m\t\r\x7f"), "\\x1b[31m\\x09\\x0d\\x7f");
  EXPECT_EQ(printable(std::string(1, '\0')), "\\x00");
  EXPECT_EQ(printable("\xc2\x9b"), "\\xc2\\x9b");                    // C1: also starts a sequence
  EXPECT_EQ(printable("\xff\xc3"), "\\xff\\xc3");                    // not UTF-8; truncated
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");                    // overlong encoding
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // surrogate
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond Unicode
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
  Table view{bad, {bad, bad}, {{{bad}, {bad}}}, {bad}};
  const auto is_plain = [](std::string text) {
    std::erase(text, '\n');
    return first_unprintable(text) == text.size();
  };
  EXPECT_TRUE(is_plain(markdown(view)));
  EXPECT_TRUE(is_plain(latex(view)));
  EXPECT_TRUE(is_plain(terminal(view)));
  EXPECT_TRUE(is_plain(csv({view})));
}

}  // namespace
}  // namespace loopbench::hostile_files_test
