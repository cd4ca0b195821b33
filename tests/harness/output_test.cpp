/// Standard streams that are full, closed or redirected, and commands on links and pipes.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <csignal>

#include "tests/support/command.hpp"

namespace loopbench::output_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class Output : public testing::Test {
 protected:
  /// With streams redirected by `shell`; err is the file "err".
  CommandResult run(const std::string& arguments, const std::string& shell) {
    const std::string line = "cd '" + folder_.path().string() + "' && '" LOOPBENCH_BINARY "' " +
                             arguments + " 2>err " + shell;
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, "", text("err")};
  }
  std::string text(const std::string& file) const { return read_all(folder_.path() / file); }

  void SetUp() override {
    folder_.file("a.txt", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 0 1 0 0 0 0 1\n3 0 0 1 0 0 0 1\n");
    folder_.file("s.yaml",
                 "datasets: [{dataset: simulated, keyframes: 40}]\nmethods: [raw]\n"
                 "metrics: [ate]\n");
  }
  TemporaryFolder folder_;
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
  EXPECT_EQ(text("out"), "{\n");
}

TEST_F(Output, AFileMayBeStandardOutputItself) {
  run("eval a.txt a.txt --csv --per-pose /dev/stdout", ">both");
  EXPECT_THAT(text("both"),
              AllOf(StartsWith("reference,estimate,protocol,protocol_version,stamp,"),
                    HasSubstr("\nsequence,repeat,method,")));
}

TEST_F(Output, ADashIsStandardOutput) {
  folder_.file("c.yaml",
               "datasets: [{dataset: simulated, keyframes: 40}]\nmethods: [raw, uniform]\n"
               "metrics: [ate]\n");
  ASSERT_EQ(run("run c.yaml --out store", ">/dev/null").exit_code, 0);
  const auto printed = [&](const std::string& arguments) {
    EXPECT_EQ(run(arguments, ">out").exit_code, 0) << arguments << text("err");
    EXPECT_FALSE(fs::exists(folder_.path() / "-")) << arguments;
    return text("out");
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
    EXPECT_THAT(result.err, HasSubstr("named '" + word + "'"));
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

TEST_F(Output, ClosedStandardStreamsCrashNothing) {
  EXPECT_EQ(run("eval a.txt a.txt", "2>&- >/dev/null").exit_code, 0);
  EXPECT_EQ(run("eval absent.txt a.txt", "<&- >&- 2>&-").exit_code, 2);
  EXPECT_EQ(run("eval a.txt a.txt", "<&- >&- 2>&-").exit_code, 2) << "the result cannot be printed";
  EXPECT_EQ(run("eval absent.txt a.txt", "2>/dev/full").exit_code, 2);
  EXPECT_EQ(run("run s.yaml --out closed", "<&- >&- 2>&-").exit_code, 2);
  EXPECT_EQ(run("run s.yaml --out closed", ">out").exit_code, 0);
  EXPECT_THAT(text("out"), HasSubstr("1 of 1 cells done (1 of them in earlier runs)"));
}

TEST_F(Output, NoCommandWaitsForAPipeInPlaceOfAStore) {
  ASSERT_EQ(mkfifo((folder_.path() / "pipe").c_str(), 0600), 0);
  for (const char* arguments : {"table pipe", "report pipe", "check pipe --baseline b"}) {
    EXPECT_EQ(run(arguments, ">out").exit_code, 2) << arguments;
  }
  EXPECT_THAT(text("err"), StartsWith("loopbench: "));
  run("table pipe", ">out");
  EXPECT_EQ(text("err"), "loopbench: pipe: is not a regular file, expected a store of results\n");
}

TEST_F(Output, AStoreIsNotWrittenThroughALink) {
  fs::create_directory(folder_.path() / "l");
  folder_.file("empty", "");
  for (const char* target : {"absent", "empty"}) {
    for (const char* part : {"results.sqlite", "results.sqlite-wal"}) {
      fs::create_symlink(folder_.path() / target, folder_.path() / "l" / part);
      EXPECT_EQ(run("run s.yaml --out l", ">/dev/null").exit_code, 2) << target;
      EXPECT_EQ(text("err"),
                std::string("loopbench: l/") + part + ": is a symbolic link, expected a store of " +
                    "results; remove it, or use another --out\n");
      EXPECT_EQ(run("run s.yaml --out l --fresh", ">/dev/null").exit_code, 2) << target;
      fs::remove(folder_.path() / "l" / part);
    }
  }
  EXPECT_FALSE(fs::exists(folder_.path() / "absent"));
  EXPECT_EQ(fs::file_size(folder_.path() / "empty"), 0u);
}

TEST_F(Output, LinksInAFolderOfResultsAreReplacedAndNotFollowed) {
  const fs::path mine = folder_.file("mine", "precious");
  fs::create_directory(folder_.path() / "r");
  const auto names = {"table.md", "table.csv", "rows.csv", "provenance.json"};
  for (const char* name : names) fs::create_symlink(mine, folder_.path() / "r" / name);
  EXPECT_EQ(run("run s.yaml --out r", ">/dev/null").exit_code, 0);
  for (const char* name : names) EXPECT_FALSE(fs::is_symlink(folder_.path() / "r" / name)) << name;
  fs::remove(folder_.path() / "r/table.md");
  fs::create_symlink(mine, folder_.path() / "r/table.md");
  EXPECT_EQ(run("run s.yaml --out r", ">out").exit_code, 0);
  EXPECT_THAT(text("out"), Not(HasSubstr("precious")));
  EXPECT_FALSE(fs::is_symlink(folder_.path() / "r/table.md"));
  fs::create_symlink(mine, folder_.path() / "t.provenance.json");
  EXPECT_EQ(run("table r --format csv -o t.csv", ">out").exit_code, 0);
  EXPECT_EQ(read_all(mine), "precious");
}

}  // namespace
}  // namespace loopbench::output_test
