/// What a program in bubblewrap can read and write.
#include "harness/sweep/process/sandbox.hpp"

#include <gtest/gtest.h>

#include <csignal>

#include "harness/sweep/process/mounts.hpp"
#include "harness/sweep/process/program.hpp"
#include "harness/sweep/store/find_stores.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::sandbox_test {

using namespace harness;

namespace {

class Sandboxed : public testing::Test {
 protected:
  Sandboxed() {
    std::filesystem::create_directory(folder_.path() / "scratch");
    for (const char* name : {"data/room/truth.txt",
                             "data/room/est.txt",
                             "data/tools/helper.txt",
                             "own/helper.txt",
                             "own/truth.txt",
                             "own/data/truth.txt"}) {
      folder_.file(name, "text\n");
    }
  }
  void SetUp() override {
    if (!has_bubblewrap()) GTEST_SKIP() << "bubblewrap does not work here";
  }

  /// What a shell script of that line, and files that it is given, prints in `own`.
  std::string printed(const std::string& line,
                      const std::vector<std::string>& hidden,
                      const std::string& file = "") {
    folder_.file("own/script.sh", line);
    SandboxOptions options;
    for (const std::string& each : hidden) options.hidden.push_back(folder_.path() / each);
    ProgramStart start;
    start.arguments = {"sh", "script.sh"};
    if (!file.empty()) start.arguments.push_back((folder_.path() / file).string());
    start.folder = folder_.path() / "own";
    start.sandbox = &options;
    start.readable = readable_;
    start.writable = folder_.path() / "scratch";
    std::string output;
    end_ = RunningProgram(start).wait(output);
    return output;
  }

  TemporaryFolder folder_;
  std::vector<std::filesystem::path> readable_;
  ProgramEnd end_;
};

TEST_F(Sandboxed, HiddenFoldersAreEmptyExceptWhatTheProgramWasGiven) {
  EXPECT_EQ(printed("ls ../data", {"data"}), "");
  readable_ = {folder_.path() / "data/room/est.txt"};
  EXPECT_EQ(printed("ls ../data ../data/room && cat ../data/room/est.txt", {"data"}),
            "../data:\nroom\n\n../data/room:\nest.txt\ntext\n");
  EXPECT_EQ(printed("ls ../data/room", {"data", "data/room/truth.txt"}, "data/room/est.txt"),
            "est.txt\n");
}

TEST_F(Sandboxed, ItsOwnFolderCanBeListedButNotHiddenFilesInIt) {
  EXPECT_EQ(printed("ls; cat helper.txt", {"own/truth.txt", "own/data"}),
            "data\nhelper.txt\nscript.sh\ntruth.txt\ntext\n");
  EXPECT_EQ(printed("cat truth.txt 2>/dev/null; ls data", {"own/truth.txt", "own/data"}), "");
  EXPECT_EQ(printed("ls " + (folder_.path() / "data/tools").string() + "; cat " +
                        (folder_.path() / "data/tools/helper.txt").string(),
                    {"data"},
                    "data/tools/helper.txt"),
            "helper.txt\ntext\n")
      << "the folder of a file in its command line";
}

TEST_F(Sandboxed, HiddenFilesStayHiddenIfItsCommandNamesThem) {
  EXPECT_EQ(printed("test -s \"$1\" && echo there", {"data/room/truth.txt"}, "data/room/truth.txt"),
            "");
  EXPECT_EQ(printed("ls ../data/room", {"data/room/truth.txt"}, "data/room/truth.txt"), "");
}

TEST_F(Sandboxed, ItWritesIntoItsFolderForTemporaryFilesOnly) {
  EXPECT_EQ(printed("echo x >../scratch/x && rm ../scratch/x && echo done", {}), "done\n");
  EXPECT_NE(printed("echo x >new || exit 3", {}), "");
  EXPECT_EQ(end_.exit_code, 3);
}

TEST_F(Sandboxed, RootHasNoMoreRightsInItThanUsers) {
  EXPECT_EQ(printed("umount ../data 2>/dev/null; ls ../data", {"data"}), "");
  EXPECT_EQ(printed("(mount -o remount,rw,bind / /; mount -o remount,rw ../data; echo x >new || "
                    "echo x >../data/new) 2>/dev/null || echo read-only",
                    {"data"}),
            "read-only\n");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "own/new"));
  EXPECT_EQ(printed("grep CapEff /proc/self/status", {}), "CapEff:\t0000000000000000\n");
  EXPECT_EQ(printed("(echo x >/dev/tty) 2>/dev/null || echo no terminal", {}), "no terminal\n");
}

TEST_F(Sandboxed, DevicesAreThere) {
  EXPECT_EQ(printed("head -c 4 /dev/urandom | wc -c; echo x >/dev/null; echo y >/dev/shm/y && "
                    "cat /dev/shm/y",
                    {}),
            "4\ny\n");
}

TEST_F(Sandboxed, EndsOfProgramsAreReportedAsWithoutIt) {
  printed("exit 7", {});
  EXPECT_EQ(end_.exit_code, 7);
  printed("kill -SEGV $$", {});
  EXPECT_EQ(end_.signal, SIGSEGV);
}

TEST(OtherNames, AreThoseOfBindMounts) {
  const std::vector<Mount> mounts = mounts_in(
      "22 1 8:1 / / rw - ext4 /dev/sda1 rw\n"
      "30 22 8:2 / /home rw shared:1 - ext4 /dev/sda2 rw\n"
      "31 22 8:1 /srv/runs /mnt/the\\040runs rw - ext4 /dev/sda1 rw\n"
      "32 22 8:2 /ann/data /data rw - ext4 /dev/sda2 rw\n"
      "33 22 0:5 / /proc rw - proc proc rw\n");
  using Paths = std::vector<std::filesystem::path>;
  EXPECT_EQ(other_names("/home/ann/data/gt.txt", mounts), Paths{"/data/gt.txt"});
  EXPECT_EQ(other_names("/data/gt.txt", mounts), Paths{"/home/ann/data/gt.txt"});
  EXPECT_EQ(other_names("/data", mounts), Paths{"/home/ann/data"});
  EXPECT_EQ(other_names("/srv/runs/a/gt.txt", mounts), Paths{"/mnt/the runs/a/gt.txt"});
  EXPECT_EQ(other_names("/mnt/the runs/x", mounts), Paths{"/srv/runs/x"});
  EXPECT_EQ(other_names("/home/ann/other", mounts), Paths{});
  EXPECT_EQ(other_names("/srv/runs2/x", mounts), Paths{});
  EXPECT_EQ(other_names("/x", {}), Paths{});
}

TEST(FilesOfOptions, AreDataAlsoInBags) {
  const TemporaryFolder folder;
  for (const char* const name : {"gt.bag", "gt.txt", "slam.py"}) folder.file(name, "x");
  const DataRoot root{{folder.path()}};
  using Paths = std::vector<std::filesystem::path>;
  EXPECT_EQ(files_of_options({{"reference", "bag:gt.bag#/gt"}}, root),
            Paths{folder.path() / "gt.bag"});
  EXPECT_EQ(files_of_options({{"reference", "gt.txt"}, {"depends", "slam.py"}}, root),
            Paths{folder.path() / "gt.txt"});
}

}  // namespace
}  // namespace loopbench::sandbox_test
