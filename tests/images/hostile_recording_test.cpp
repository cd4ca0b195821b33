// Recordings that name devices, pipes and files elsewhere, or images beyond all limits.
#include <sys/stat.h>

#include <fstream>

#include "tests/images/recording.hpp"

namespace loopbench::hostile_recording_test {

namespace {

using testing::EndsWith;
using testing::HasSubstr;
using HostileRecording = RecordedRoom;

TEST_F(HostileRecording, RejectsListedPathsOutsideOfItsFolder) {
  const std::string outside = "' is outside of the folder of the list, expected a path below it";
  for (const char* path : {"/dev/zero", "../other/0000.png", "rgb/../../other.png", ".."}) {
    folder_.file("rgb.txt", std::string("0.0 rgb/0000.png\n0.1 ") + path + "\n");
    EXPECT_THAT(refusal(), HasSubstr("rgb.txt:2: '" + std::string(path) + outside));
  }
  folder_.file("rgb.txt", "0.0 rgb/../rgb/0000.png\n");
  EXPECT_EQ(refusal(), "");
  folder_.file("depth.txt", "0.0 /dev/zero\n");
  EXPECT_THAT(refusal(), HasSubstr("depth.txt:1: '/dev/zero" + outside));
}

TEST_F(HostileRecording, ReadsRegularFilesOnlyAlsoBehindLinks) {
  const std::filesystem::path rgb = folder_.path() / "rgb";
  const auto replaced_by = [&](const char* target) {
    std::filesystem::remove_all(rgb / "0001.png");
    std::filesystem::create_symlink(target, rgb / "0001.png");
  };
  replaced_by("0002.png");
  EXPECT_EQ(unreadable(1), "");
  replaced_by("/dev/zero");
  EXPECT_THAT(unreadable(1), EndsWith("rgb/0001.png: is not a regular file, expected an image"));
  replaced_by("pipe");
  ASSERT_EQ(mkfifo((rgb / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(unreadable(1), EndsWith("rgb/0001.png: is not a regular file, expected an image"));
  replaced_by("../depth");
  EXPECT_THAT(unreadable(1), EndsWith("rgb/0001.png: is a folder, expected an image"));
}

TEST_F(HostileRecording, DoesNotWaitForPipesInItsFolder) {
  for (const char* name : {"camera.yaml", "groundtruth.txt", "depth.txt", "rgb.txt"}) {
    const std::filesystem::path file = folder_.path() / name;
    const std::filesystem::path kept = folder_.path() / "kept";
    const bool exists = std::filesystem::exists(file);
    if (exists) std::filesystem::rename(file, kept);
    ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
    EXPECT_THAT(refusal(),
                HasSubstr(std::string(name) + ": is not a regular file, expected a text file"));
    std::filesystem::remove(file);
    if (exists) std::filesystem::rename(kept, file);
  }
  EXPECT_EQ(refusal(), "");
}

/// Signature and header of a PNG with 8 bits per pixel.
std::string png_header(std::uint32_t width, std::uint32_t height) {
  std::string out = "\x89PNG\r\n\x1a\n";
  const auto number = [&](std::uint32_t n) {
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(n >> shift & 255);
  };
  number(13);
  out += "IHDR";
  number(width);
  number(height);
  out += std::string("\x08\x00\x00\x00\x00", 5);  // 8 bits, grey
  number(0);                                      // the decoder does not check sums
  return out;
}

TEST_F(HostileRecording, RejectsTooManyPixelsBeforeDecoding) {
  folder_.file("rgb/0001.png", png_header(30'000, 30'000));
  folder_.file("rgb/0002.png", png_header(0x7fffffff, 0x7fffffff));
  EXPECT_THAT(unreadable(1),
              EndsWith("rgb/0001.png: has 30000 x 30000 pixels, expected at most 67108864 in all"));
  EXPECT_THAT(unreadable(2), HasSubstr("rgb/0002.png: "));
}

TEST_F(HostileRecording, RejectsCompressedDataThatExpandBeyondTheImage) {
  // 9 MB of zeros, a few kilobytes compressed, behind the header of an image of 160 x 120 pixels.
  const cv::Mat large(3'000, 3'000, CV_8U, cv::Scalar(0));
  const std::filesystem::path bomb = folder_.path() / "rgb/0001.png";
  cv::imwrite(bomb.string(), large, {cv::IMWRITE_PNG_COMPRESSION, 9});
  std::fstream file(bomb, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(0);
  const std::string header = png_header(160, 120);
  file.write(header.data(), static_cast<std::streamsize>(header.size()));
  file.close();
  EXPECT_THAT(unreadable(1), EndsWith("rgb/0001.png: is not a valid PNG or JPEG: outofmem"));
}

TEST_F(HostileRecording, RejectsImageSizesThatAreNoNumberOfPixels) {
  for (const char* width : {"1e308", "0", "-1", "640.5", "8193"}) {
    folder_.file("camera.yaml", std::string("width: ") + width + "\n");
    EXPECT_THAT(refusal(), HasSubstr("expected a whole number from 1 to 8192"));
  }
}

}  // namespace
}  // namespace loopbench::hostile_recording_test
