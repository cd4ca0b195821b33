/// Files that are refused as a whole; those of the manifest in tests/data/bad are in the transcript
/// run_config.
#include <gtest/gtest.h>

#include "datasets/core/params.hpp"
#include "datasets/formats/formats.hpp"
#include "datasets/formats/g2o.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::bad_files_test {
namespace {

TEST(BadFiles, MissingFilesAndFoldersAreRefused) {
  const auto missing = sample("nowhere.txt");
  EXPECT_EQ(refusal([&] { read_trajectory(missing); }), missing.string() + ": no such file");
  EXPECT_EQ(refusal([&] { read_g2o(missing); }), missing.string() + ": no such file");
  const auto folder = sample("bad");
  EXPECT_EQ(refusal([&] { detect_format(folder); }),
            folder.string() + ": is a directory, expected a text file");
}

TEST(BadFiles, AbsurdSizesAreRefusedUnread) {
  const TemporaryFolder scratch;
  const auto file = scratch.file("huge.txt", "0 0 0 0 0 0 0 1\n");
  std::filesystem::resize_file(file, std::uintmax_t{9} << 30);  // sparse file
  EXPECT_EQ(refusal([&] { read_trajectory(file); }),
            file.string() + ": has 9663676416 bytes, expected at most 8589934592");
}

TEST(BadFiles, TimesMustMatchThePoses) {
  const auto poses = sample("good/kitti.txt");
  const auto refuse = [&](const std::string& name) {
    return refusal([&] { read_trajectory(poses, {.times = sample("bad/" + name)}); });
  };
  EXPECT_EQ(refuse("times_two.txt"),
            poses.string() + ": has 3 poses, but " + sample("bad/times_two.txt").string() +
                " has 2 times, expected equal numbers");
  EXPECT_EQ(refuse("times_unsorted.txt"),
            sample("bad/times_unsorted.txt").string() +
                ":3: stamp 0.1 is smaller than stamp 0.2 on line 2, expected increasing stamps "
                "(--sort, or sort: true in a config)");
  EXPECT_EQ(refuse("times_two_columns.txt"),
            sample("bad/times_two_columns.txt").string() +
                ":1: has 2 columns, expected 1: a time in seconds, or a time and a file name");
  EXPECT_EQ(refuse("nowhere.txt"), sample("bad/nowhere.txt").string() + ": no such file");
}

TEST(BadFiles, AFormatGivenByHandIsHeldTo) {
  const auto refuse = [&](const std::string& name, Format format) {
    const std::string path = sample("good/" + name).string();
    const std::string text = refusal([&] { read_trajectory(path, {.format = format}); });
    return text.starts_with(path) ? text.substr(path.size()) : text;
  };
  EXPECT_EQ(refuse("kitti.txt", Format::tum),
            ":1: has 12 columns, expected 8: stamp tx ty tz qx qy qz qw (looks like kitti)");
  EXPECT_EQ(refuse("tum.txt", Format::kitti),
            ":2: has 8 columns, expected 12: a 3 x 4 pose row by row (looks like tum)");
  EXPECT_EQ(refuse("se2.g2o", Format::tum),
            ":2: column 1 (stamp): 'VERTEX_SE2' is not a number (looks like g2o)");
  EXPECT_EQ(refuse("euroc.csv", Format::tum),
            ":2: has 9 columns, expected 8: stamp tx ty tz qx qy qz qw (looks like euroc)");
  EXPECT_EQ(refuse("tum.txt", Format::euroc),
            ":2: column 1 (nanoseconds): '1.5' is not a whole number");
}

TEST(BadFiles, TimesBesideAFormatWithStampsAreRefused) {
  ReadOptions options;
  options.times = sample("good/kitti_times.txt");
  const auto file = sample("good/tum.txt");
  EXPECT_EQ(refusal([&] { read_trajectory(file, options); }),
            file.string() + ": has format tum with stamps, expected no times file");
  options = {};
  options.period = 0.0;
  EXPECT_THROW(read_trajectory(file, options), OptionError);
}

}  // namespace
}  // namespace loopbench::bad_files_test
