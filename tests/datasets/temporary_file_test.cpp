/// Temporary files of killed processes are removed; those in use and files of others are kept.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <set>

#include "datasets/formats/replace_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::temporary_file_test {
namespace {

std::set<std::string> names(const std::filesystem::path& folder) {
  std::set<std::string> out;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    out.insert(file.path().filename());
  }
  return out;
}

/// Writes a part of a file and is killed before the rest.
void killed_writer(const std::filesystem::path& file) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    PendingFile pending(file, Target::own);
    pending.write("half of it");
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
}

TEST(TemporaryFile, OfAKilledProcessIsRemovedByTheNextWriter) {
  const TemporaryFolder folder;
  killed_writer(folder.path() / "table.md");
  EXPECT_EQ(names(folder.path()).size(), 1u);
  replace_file(folder.path() / "rows.csv", "whole", Target::own);
  EXPECT_EQ(names(folder.path()), std::set<std::string>{"rows.csv"});
}

TEST(TemporaryFile, InUseIsKept) {
  const TemporaryFolder folder;
  PendingFile pending(folder.path() / "table.md", Target::own);
  pending.write("whole");
  replace_file(folder.path() / "rows.csv", "whole", Target::own);
  EXPECT_EQ(names(folder.path()).size(), 2u);
  pending.commit();
  EXPECT_EQ(names(folder.path()), (std::set<std::string>{"rows.csv", "table.md"}));
}

TEST(TemporaryFile, IsToldFromFilesOfOthersByItsName) {
  const TemporaryFolder folder;
  const std::set<std::string> others{".loopbench-notes", ".loopbench-0123456789abcdeg"};
  for (const std::string& name : others) std::ofstream(folder.path() / name) << "mine";
  std::filesystem::create_symlink(folder.path() / ".loopbench-notes",
                                  folder.path() / ".loopbench-0123456789abcdef");
  replace_file(folder.path() / "rows.csv", "whole", Target::own);
  EXPECT_EQ(names(folder.path()).size(), 4u);
}

}  // namespace
}  // namespace loopbench::temporary_file_test
