#include "datasets/files/replace_file.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "tests/support/temporary_folder.hpp"

namespace loopbench::test::replace_file_test {
namespace {

// A process that writes into a folder for the first time removes files that were left there; those
// that are about to be renamed are not left.
TEST(ReplaceFile, LosesNoFileToAProcessThatCleansUp) {
  const TemporaryFolder folder;
  constexpr int kCleaners = 20, kSpellings = 100;
  int lost = 0, status = 0;
  for (int i = 0; i < kCleaners; ++i) {
    const pid_t cleaner = fork();
    if (cleaner == 0) {
      std::filesystem::path other = folder.path();  // once for each spelling of the folder
      for (int k = 0; k < kSpellings; ++k) {
        other /= ".";
        replace_file(other / "other", "text", Target::own);
      }
      _exit(0);
    }
    const WithoutSync fast;
    while (waitpid(cleaner, &status, WNOHANG) == 0) {
      try {
        replace_file(folder.path() / "mine", "text", Target::own);
      } catch (const std::exception&) {
        ++lost;
      }
    }
  }
  EXPECT_EQ(lost, 0);
}

}  // namespace
}  // namespace loopbench::test::replace_file_test
