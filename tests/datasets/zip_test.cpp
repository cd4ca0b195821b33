#include "datasets/compressed/zip.hpp"

#include <gtest/gtest.h>

#include "datasets/compressed/decompress.hpp"
#include "datasets/formats/formats.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::zip_test {
namespace {

std::string bytes_of(const std::string& hex) {
  std::string out;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    out += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  }
  return out;
}

/// "a/run.txt" with two poses, deflated by Python's zipfile.
const std::string kDeflated = bytes_of(
    "504b0304140000000800000021003ddb23020e0000002000000009000000612f72756e2e74787433503040"
    "82865c860a1008e30300504b01021403140000000800000021003ddb23020e000000200000000900000000"
    "00000000000000800100000000612f72756e2e747874504b05060000000001000100370000003500000000"
    "00");

/// "a.txt" with "text" and an empty file "empty", stored by Python's zipfile.
const std::string kTwoFiles = bytes_of(
    "504b030414000000000000002100c7a78b3b040000000400000005000000612e74787474657874504b030414"
    "00000000000000210000000000000000000000000005000000656d707479504b010214031400000000000000"
    "2100c7a78b3b0400000004000000050000000000000000000000800100000000612e747874504b0102140314"
    "000000000000002100000000000000000000000000050000000000000000000000800127000000656d707479"
    "504b05060000000002000200660000004a0000000000");

/// "0 0 0 0 0 0 0 1" by Python's lzma.
const std::string kXz = bytes_of(
    "fd377a585a000004e6d6b4460200210116000000742fe5a3e0000f000a5d0018082502310526b40000000000"
    "e208d37d755d5a7b000126106b26effe1fb6f37d010000000004595a");

TEST(Zip, ReadsStoredFiles) {
  ASSERT_TRUE(is_zip(kTwoFiles));
  const std::vector<ZipMember> read = zip_members(kTwoFiles, 1000);
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].name, "a.txt");
  EXPECT_EQ(read[0].content, "text");
  EXPECT_EQ(read[1].content, "");
  EXPECT_THROW(zip_members(kTwoFiles, 3), ExpandsTooFar);
}

TEST(Zip, TrajectoriesCanBeCompressed) {
  const TemporaryFolder scratch;
  EXPECT_EQ(read_trajectory(scratch.file("run.zip", kDeflated)).size(), 2u);
  EXPECT_EQ(read_trajectory(scratch.file("run.xz", kXz)).size(), 1u);
  const auto two = scratch.file("two.zip", kTwoFiles);
  EXPECT_EQ(refusal([&] { read_trajectory(two); }),
            two.string() + ": is a zip archive of 2 files, expected one (a.txt, empty)");
}

TEST(Zip, RejectsDamage) {
  for (std::size_t size = 4; size < kDeflated.size(); ++size) {
    EXPECT_THROW(zip_members(kDeflated.substr(0, size), 1000), DamagedStream) << size;
  }
  for (std::size_t i = 0; i < kDeflated.size(); ++i) {
    std::string damaged = kDeflated;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
    try {
      zip_members(damaged, 1000);  // names and times have no checksum
    } catch (const DamagedStream&) {
    }
  }
}

}  // namespace
}  // namespace loopbench::zip_test
