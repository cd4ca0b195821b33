// Recordings that name devices, pipes and files elsewhere, or images beyond all limits.
#include <sys/stat.h>

#include <fstream>

#include "datasets/rgbd/folder/folder_source.hpp"
#include "tests/rgbd/recording.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::hostile_recording_test {

using namespace rgbd;

namespace {

class HostileRecording : public testing::Test {
 protected:
  HostileRecording() { write_recording(folder_, *rendered_room(small_room(0.01))); }

  std::unique_ptr<const RgbdSource> open() const { return open_rgbd_folder(folder_.path(), {}); }
  std::string refusal() const {
    return refusal_of([&] { open(); });
  }
  bool refuses_with(const std::string& text) const {
    const std::string message = refusal();
    return message.find(text) != std::string::npos ? true : (ADD_FAILURE() << message, false);
  }

  TemporaryFolder folder_;
};

TEST_F(HostileRecording, RejectsListedPathsOutsideOfItsFolder) {
  const std::string outside = "' is outside of the folder of the list, expected a path below it";
  for (const char* path : {"/dev/zero", "../other/0000.png", "rgb/../../other.png", ".."}) {
    folder_.file("rgb.txt", std::string("0.0 rgb/0000.png\n0.1 ") + path + "\n");
    EXPECT_TRUE(refuses_with("rgb.txt:2: '" + std::string(path) + outside));
  }
  folder_.file("rgb.txt", "0.0 rgb/../rgb/0000.png\n");
  EXPECT_EQ(refusal(), "");
  folder_.file("depth.txt", "0.0 /dev/zero\n");
  EXPECT_TRUE(refuses_with("depth.txt:1: '/dev/zero" + outside));
}

TEST_F(HostileRecording, ReadsRegularFilesOnlyAlsoBehindLinks) {
  const std::filesystem::path rgb = folder_.path() / "rgb";
  const auto replaced_by = [&](const char* target) {
    std::filesystem::remove_all(rgb / "0001.png");
    std::filesystem::create_symlink(target, rgb / "0001.png");
  };
  std::string why;
  replaced_by("0002.png");
  EXPECT_TRUE(open()->read(1, why)) << why;
  replaced_by("/dev/zero");
  EXPECT_FALSE(open()->read(1, why));
  EXPECT_TRUE(why.ends_with("rgb/0001.png: is not a regular file, expected an image")) << why;
  replaced_by("pipe");
  ASSERT_EQ(mkfifo((rgb / "pipe").c_str(), 0600), 0);
  EXPECT_FALSE(open()->read(1, why));
  EXPECT_TRUE(why.ends_with("rgb/0001.png: is not a regular file, expected an image")) << why;
  replaced_by("../depth");
  EXPECT_FALSE(open()->read(1, why));
  EXPECT_TRUE(why.ends_with("rgb/0001.png: is a folder, expected an image")) << why;
}

TEST_F(HostileRecording, DoesNotWaitForPipesInItsFolder) {
  for (const char* name : {"camera.yaml", "groundtruth.txt", "depth.txt", "rgb.txt"}) {
    const std::filesystem::path file = folder_.path() / name;
    const std::filesystem::path kept = folder_.path() / "kept";
    const bool exists = std::filesystem::exists(file);
    if (exists) std::filesystem::rename(file, kept);
    ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
    EXPECT_TRUE(refuses_with(std::string(name) + ": is not a regular file, expected a text file"));
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
  std::string why;
  EXPECT_FALSE(open()->read(1, why));
  EXPECT_TRUE(
      why.ends_with("rgb/0001.png: has 30000 x 30000 pixels, expected at most 67108864 in all"))
      << why;
  EXPECT_FALSE(open()->read(2, why));
  EXPECT_NE(why.find("rgb/0002.png: "), std::string::npos) << why;
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
  std::string why;
  EXPECT_FALSE(open()->read(1, why));
  EXPECT_TRUE(why.ends_with("rgb/0001.png: is not a valid PNG or JPEG: outofmem")) << why;
}

TEST_F(HostileRecording, RejectsImageSizesThatAreNoNumberOfPixels) {
  for (const char* width : {"1e308", "0", "-1", "640.5", "8193"}) {
    folder_.file("camera.yaml", std::string("width: ") + width + "\n");
    EXPECT_TRUE(refuses_with("expected a whole number from 1 to 8192"));
  }
}

}  // namespace
}  // namespace loopbench::hostile_recording_test
