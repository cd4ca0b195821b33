/// Output is written completely or an error is reported; existing files are not destroyed.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <thread>

#include "datasets/core/error.hpp"
#include "harness/base/printable.hpp"
#include "harness/base/write_file.hpp"
#include "tests/support/command.hpp"

namespace loopbench::output_test {

using namespace harness;

namespace {

namespace fs = std::filesystem;

std::string why_unwritten(const fs::path& file) {
  try {
    write_file(file, "new");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
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

TEST(WriteFile, KnowsAnInputByAnyName) {
  const TemporaryFolder folder;
  const fs::path input = folder.file("input", "old");
  fs::create_hard_link(input, folder.path() / "twin");
  EXPECT_THROW(reject_overwriting({"absent", input}, folder.path() / "twin"), InputError);
  EXPECT_NO_THROW(reject_overwriting({input}, folder.path() / "new"));
  EXPECT_NO_THROW(reject_overwriting({input}, ""));
  EXPECT_NO_THROW(reject_overwriting({"/dev/null"}, "/dev/null"));
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

class Output : public testing::Test {
 protected:
  /// With standard output redirected by `shell`; returns standard error.
  CommandResult run(const std::string& arguments, const std::string& shell) {
    const std::string line = "cd '" + folder_.path().string() + "' && '" LOOPBENCH_BINARY "' " +
                             arguments + " 2>err " + shell;
    const int status = std::system(line.c_str());
    return {WEXITSTATUS(status), "", read_all(folder_.path() / "err")};
  }
  TemporaryFolder folder_;
  const fs::path poses_ =
      folder_.file("a.txt", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 0 1 0 0 0 0 1\n3 0 0 1 0 0 0 1\n");
};

TEST_F(Output, AFullDiskBehindStandardOutputIsTold) {
  // Smaller and larger than the buffer; printed by our code and by CLI11.
  for (const char* arguments : {"eval a.txt a.txt",
                                "eval a.txt a.txt --json",
                                "list",
                                "list --json",
                                "--version",
                                "eval --help"}) {
    const CommandResult result = run(arguments, ">/dev/full");
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(result.err, "loopbench: cannot write to standard output: No space left on device\n")
        << arguments;
  }
}

TEST_F(Output, AReaderThatHasHeardEnoughIsNoError) {
  EXPECT_EQ(run("list --json", "| head -1 >out").err, "");
  const auto before = std::signal(SIGPIPE, SIG_IGN);  // inherited from some callers
  EXPECT_EQ(run("list --json", "| head -1 >out").err, "");
  std::signal(SIGPIPE, before);
  EXPECT_EQ(read_all(folder_.path() / "out"), "{\n");
}

TEST_F(Output, AFileMayBeStandardOutputItself) {
  run("eval a.txt a.txt --csv --per-pose /dev/stdout", ">both");
  const std::string both = read_all(folder_.path() / "both");
  EXPECT_EQ(both.find("reference,estimate,protocol,protocol_version,stamp,"), 0u) << both;
  EXPECT_NE(both.find("\nsequence,repeat,method,"), std::string::npos);
}

TEST_F(Output, ADashIsStandardOutput) {
  folder_.file("c.yaml",
               "datasets: [{dataset: simulated, keyframes: 40}]\nmethods: [raw, uniform]\n"
               "metrics: [ate]\n");
  ASSERT_EQ(run("run c.yaml --out store", ">/dev/null").exit_code, 0);
  const auto printed = [&](const std::string& arguments) {
    EXPECT_EQ(run(arguments, ">out").exit_code, 0) << arguments << read_all(folder_.path() / "err");
    EXPECT_FALSE(fs::exists(folder_.path() / "-")) << arguments;
    return read_all(folder_.path() / "out");
  };
  EXPECT_EQ(printed("table store -o -"), printed("table store"));
  EXPECT_EQ(printed("table store --format csv -o -"), printed("table store --format csv"));
  EXPECT_EQ(printed("compare store -o - --where times=dense").substr(0, 3), "###");
  EXPECT_EQ(printed("report store -o -").substr(0, 9), "<!DOCTYPE");
  EXPECT_EQ(printed("check store --update --allow-dirty --baseline -").substr(0, 2), "{\n");
  EXPECT_EQ(printed("eval a.txt a.txt --csv --per-pose -").substr(0, 19), "reference,estimate,");
  ASSERT_EQ(run("check store --update --allow-dirty --baseline b", ">/dev/null").exit_code, 0);
  EXPECT_EQ(printed("check store --allow-dirty --baseline b --junit -").substr(0, 5), "<?xml");
  for (const char* arguments :
       {"plot store -o -", "merge store store -o -", "run c.yaml --out -"}) {
    EXPECT_EQ(run(arguments, ">out").exit_code, 2) << arguments;
    EXPECT_FALSE(fs::exists(folder_.path() / "-")) << arguments;
  }
}

TEST_F(Output, AnUnknownWordIsNamed) {
  const auto named = [&](const std::string& arguments, const std::string& word) {
    const CommandResult result = run(arguments, ">out");
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_NE(result.err.find("named '" + word + "'"), std::string::npos) << result.err;
  };
  named("eva a b", "eva");
  named("--foo", "--foo");
  named("traj inf a.txt", "inf");
  named("traj crop a.txt --strt 1", "--strt");
  named("table x --format foo", "foo");
  named("'e\x1b[31m'", "e\\x1b[31m");
}

TEST_F(Output, HyphensAndUnderscoresAreOne) {
  for (const char* arguments : {"eval a.txt a.txt --all-pairs --delta_unit m",
                                "eval a.txt a.txt --min_coverage=0.5 --max_diff 1",
                                "eval a.txt a.txt --align_origin",
                                "eval a.txt a.txt --align-origin"}) {
    EXPECT_EQ(run(arguments, ">out").err, "") << arguments;
  }
}

}  // namespace
}  // namespace loopbench::output_test
