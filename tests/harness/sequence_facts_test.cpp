#include "harness/run/sequence_facts.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace loopbench {
namespace {

TEST(HashedInputs, OneThatASequenceDidWithoutIsKnownWhenItComes) {
  const TemporaryFolder folder;
  const auto image = folder.path() / "depth/0002.png";
  const InputFile missing = hashed_inputs({image}).front();
  EXPECT_EQ(missing.path, image.string());
  EXPECT_EQ(missing.bytes, 0u);
  EXPECT_EQ(missing.hash, std::string(32, '0'));
  std::filesystem::create_directories(image.parent_path());
  std::ofstream(image) << "pixels";
  const InputFile come = hashed_inputs({image}).front();
  EXPECT_EQ(come.bytes, 6u);
  EXPECT_NE(come.hash, missing.hash);
}

}  // namespace
}  // namespace loopbench
