#include "datasets/formats/trajectory_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "datasets/columns/stamps.hpp"
#include "datasets/compressed/decompress.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::trajectory_file_test {
namespace {

using testing::HasSubstr;

// The same two poses in three forms; the stamps are no doubles.
constexpr const char* kTum =
    "1403715271.262142976 0.1 -0.25 3e-3 0 0 0 1\n"
    "1403715271.312143001 0.2 -0.5 1 0.5 0.5 0.5 0.5\n";
constexpr const char* kEuroc =
    "# timestamp [ns],p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []\n"
    "1403715271262142976,0.1,-0.25,0.003,1,0,0,0\n"
    "1403715271312143001,0.2,-0.5,1,0.5,0.5,0.5,0.5\n";
constexpr const char* kCsv =
    "timestamp,x,y,z,qx,qy,qz,qw\n"
    "1403715271.262142976,0.1,-0.25,0.003,0,0,0,1\n"
    "1403715271.312143001,0.2,-0.5,1,0.5,0.5,0.5,0.5\n";

TEST(TrajectoryFile, ConversionKeepsEveryDigitOfStampsAndPoses) {
  const TemporaryFolder scratch;
  const auto tum = read_trajectory_file(scratch.file("a.txt", kTum));
  const auto euroc = read_trajectory_file(scratch.file("b.csv", kEuroc));
  const auto csv = read_trajectory_file(scratch.file("c.csv", kCsv));
  EXPECT_EQ(csv.format, Format::csv);
  EXPECT_EQ(euroc.format, Format::euroc);
  for (const TrajectoryFile& file : {tum, euroc, csv}) {
    write_trajectory(scratch.path() / "out.csv", file, Format::euroc);
    EXPECT_EQ(read_all(scratch.path() / "out.csv"), kEuroc);
    write_trajectory(scratch.path() / "out2.csv", file, Format::csv);
    EXPECT_EQ(read_all(scratch.path() / "out2.csv"), kCsv);
    write_trajectory(scratch.path() / "out.txt", file, Format::tum);
    EXPECT_EQ(read_all(scratch.path() / "out.txt").substr(0, 24), "1403715271.262142976 0.1");
  }
}

TEST(TrajectoryFile, StampsWithMoreThanNineDecimalsRemainDoubles) {
  const TemporaryFolder scratch;
  const auto file = read_trajectory_file(scratch.file("a.txt", "0.12345678901 1 2 3 0 0 0 1\n"));
  EXPECT_TRUE(file.nanoseconds.empty());
  write_trajectory(scratch.path() / "b.txt", file, Format::tum);
  EXPECT_EQ(read_all(scratch.path() / "b.txt"), "0.12345678901 1 2 3 0 0 0 1\n");
}

TEST(TrajectoryFile, StampsThatAreNoNanosecondsAreNotWritten) {
  const TemporaryFolder scratch;
  const auto why = [&](double first, double second, Format format) {
    TrajectoryFile file;
    file.poses = {{first, Pose{}}, {second, Pose{}}};
    return refusal_of<InputError>([&] { write_trajectory(scratch.path() / "out", file, format); });
  };
  EXPECT_THAT(why(1.7e12, 1.7e12 + 100.0, Format::euroc),
              HasSubstr("out: nanoseconds of stamp 1700000000000 do not fit in 64 bits"));
  EXPECT_THAT(why(1e300, 2e300, Format::euroc), HasSubstr("do not fit"));
  EXPECT_THAT(why(0.0, 1e-10, Format::euroc), HasSubstr("stamps 0 and 1e-10 are one nanosecond"));
  EXPECT_THAT(why(1.0, 2.0, Format::bag), HasSubstr("found bag, expected tum, kitti"));
  EXPECT_FALSE(std::filesystem::exists(scratch.path() / "out"));
  EXPECT_EQ(why(1.0, 2.0, Format::euroc), "");
}

TEST(TrajectoryFile, StampsAreExactDecimals) {
  EXPECT_EQ(exact_nanoseconds("1.305031102175304e+09"), 1305031102175304000);
  EXPECT_EQ(exact_nanoseconds("-0.5"), -500'000'000);
  EXPECT_EQ(exact_nanoseconds("0.0000000010"), 1);
  EXPECT_EQ(exact_nanoseconds("0.0000000011"), std::nullopt);
  EXPECT_EQ(exact_nanoseconds("1e300"), std::nullopt);
  EXPECT_EQ(exact_nanoseconds("9999999999999"), std::nullopt);
  EXPECT_EQ(exact_nanoseconds("12,5"), std::nullopt);
  EXPECT_EQ(seconds_text(-500'000'000), "-0.5");
  EXPECT_EQ(seconds_text(1305031102175304000), "1305031102.175304");
  EXPECT_EQ(seconds_text(1), "0.000000001");
  EXPECT_EQ(seconds_text(10'000'000'000), "10");
}

TEST(TrajectoryFile, AHeaderWithOtherNamesIsSkipped) {
  const TemporaryFolder scratch;
  const auto poses = read_trajectory(
      scratch.file("a.txt", "some words here\n0.5 1 2 3 0 0 0 1\n0.6 1 2 3 0 0 0 1\n"));
  EXPECT_EQ(poses.size(), 2u);
  EXPECT_EQ(refusal([&] {
              read_trajectory(scratch.file("b.txt", "some words here\n0.5 1 2 3 0 0 0 1\n0.6 1\n"));
            }).substr((scratch.path() / "b.txt").string().size()),
            ":3: has 2 columns, expected 8: stamp tx ty tz qx qy qz qw");
}

// printf '0.5 1 2 3 0 0 0 1\n' | gzip | xxd
const std::string kGzip(
    "\x1f\x8b\x08\x00\x00\x00\x00\x00\x00\x03\x33\xd0\x33\x55\x30\x54\x30\x52\x30\x56\x30\x00\x43"
    "\x43\x2e\x00",
    26);

TEST(TrajectoryFile, DamagedCompressedFilesAreRejected) {
  const TemporaryFolder scratch;
  EXPECT_THAT(refusal([&] { read_trajectory(scratch.file("a.txt.gz", kGzip)); }),
              HasSubstr("cannot be decompressed: ends early"));
  EXPECT_THROW(decompress(Codec::zstd, "\x28\xb5\x2f\xfd nonsense", 100), DamagedStream);
  EXPECT_THROW(decompress(Codec::lz4, "\x04\x22\x4d\x18 nonsense", 100), DamagedStream);
  EXPECT_THROW(decompress(Codec::bzip2, "BZh9nonsense", 100), DamagedStream);
}

TEST(TrajectoryFile, CompressedFilesAndPipesAreRead) {
  const TemporaryFolder scratch;
  const auto plain = scratch.file("a.txt", kTum);
  for (const char* const program : {"gzip", "bzip2", "zstd -q", "lz4 -q"}) {
    const std::string command = std::string(program) + " -c '" + plain.string() + "' > '" +
                                (scratch.path() / "b").string() + "' 2>/dev/null";
    if (std::system(command.c_str()) != 0) continue;  // not installed
    EXPECT_EQ(read_trajectory(scratch.path() / "b").size(), 2u) << program;
    std::filesystem::remove(scratch.path() / "b");
  }
  EXPECT_EQ(read_trajectory_file(Pipe(kTum).path()).nanoseconds.size(), 2u);  // reads it twice
}

TEST(TrajectoryFile, NamedPipesAreRejectedWithoutWaitingForAWriter) {
  const TemporaryFolder scratch;
  const auto pipe = scratch.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(refusal([&] { read_trajectory(pipe); }), HasSubstr("is a named pipe"));
}

TEST(TrajectoryFile, CompressedFilesThatExpandTooFarAreRejected) {
  const TemporaryFolder scratch;
  const std::string file = (scratch.path() / "zeros.gz").string();
  if (std::system(("head -c 70M /dev/zero | gzip > '" + file + "'").c_str()) != 0) GTEST_SKIP();
  EXPECT_THAT(
      refusal([&] { read_trajectory(file); }),
      AllOf(HasSubstr("expands to more than 67108864 bytes"), HasSubstr("decompress it first")));
}

}  // namespace
}  // namespace loopbench::trajectory_file_test
