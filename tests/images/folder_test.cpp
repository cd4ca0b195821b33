// Tests of the layouts of recordings, and of error messages for faulty ones.
#include "datasets/images/folder/layouts.hpp"
#include "datasets/images/folder/register_depth.hpp"
#include "tests/images/recording.hpp"

namespace loopbench::folder_test {

namespace {

using testing::HasSubstr;
using RgbdFolder = RecordedRoom;

TEST_F(RgbdFolder, GivesBackWhatWasWritten) {
  const auto source = open();
  ASSERT_EQ(source->size(), room_->size());
  std::string why;
  for (std::size_t i = 0; i < source->size(); ++i) {
    const auto read = source->read(i, why);
    ASSERT_TRUE(read) << why;
    EXPECT_EQ(read->grey.pixels, room_->read(i, why)->grey.pixels);
    EXPECT_EQ(read->depth.pixels, room_->read(i, why)->depth.pixels);
  }
  EXPECT_EQ(source->reference().size(), room_->reference().size());
  EXPECT_DOUBLE_EQ(source->camera().fx, room_->camera().fx);
}

TEST_F(RgbdFolder, TellsATruncatedPngAndAMissingDepthImage) {
  std::filesystem::resize_file(folder_.path() / "rgb/0001.png", 3000);
  std::filesystem::remove(folder_.path() / "depth/0002.png");
  EXPECT_THAT(unreadable(1), HasSubstr("rgb/0001.png: is not a valid PNG or JPEG"));
  EXPECT_THAT(unreadable(2), HasSubstr("depth/0002.png: no such image"));
  EXPECT_EQ(unreadable(3), "");
}

TEST_F(RgbdFolder, TellsADepthImageOfEightBits) {
  std::filesystem::copy_file(folder_.path() / "rgb/0001.png",
                             folder_.path() / "depth/0001.png",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(unreadable(1), HasSubstr("expected a 16-bit PNG"));
}

TEST_F(RgbdFolder, RefusesListsThatAreEmptyOrBroken) {
  folder_.file("rgb.txt", "# color images\n");
  EXPECT_THAT(refusal(), HasSubstr("rgb.txt: lists no image"));
  folder_.file("rgb.txt", "0.0 rgb/0000.png\n0.0 rgb/0001.png\n");
  EXPECT_THAT(refusal(), HasSubstr("rgb.txt:2: stamp does not increase"));
  folder_.file("rgb.txt", "0.0\n");
  EXPECT_THAT(refusal(), HasSubstr("rgb.txt:1: expected two columns"));
  folder_.file("rgb.txt", "100.0 rgb/0000.png\n");
  EXPECT_THAT(refusal(), HasSubstr("depth.txt: found no depth image within pair_gap = 0.02 s"));
}

TEST_F(RgbdFolder, RefusesIntrinsicsThatCannotBe) {
  folder_.file("camera.yaml", "fx: 0\n");
  EXPECT_THAT(refusal(), HasSubstr("camera.yaml:1: fx = 0: expected fx > 0"));
  folder_.file("camera.yaml", "fx: wide\n");
  EXPECT_THAT(refusal(), HasSubstr("camera.yaml:1: fx = 'wide': expected a number"));
  folder_.file("camera.yaml", "fx: 100\nfy: 100\ncx: 50\n");
  EXPECT_THAT(refusal(), HasSubstr("camera.yaml: has no key cy"));
  folder_.file("camera.yaml", "width: 160\nheight: 120\nfx: 100\nfy: 100\ncx: 320\ncy: 240\n");
  EXPECT_THAT(refusal(),
              HasSubstr("principal point (320, 240) is outside the image of 160 x 120 pixels"));
}

TEST_F(RgbdFolder, TellsImagesOfAnotherSizeThanTheCameras) {
  folder_.file("camera.yaml", "fx: 525\nfy: 525\ncx: 320\ncy: 240\n");  // 640 x 480
  EXPECT_THAT(unreadable(0), HasSubstr("has 160 x 120 pixels, expected 640 x 480"));
}

TEST_F(RgbdFolder, KnowsPublishedCamerasByNameAndAsksOtherwise) {
  std::filesystem::remove(folder_.path() / "camera.yaml");
  EXPECT_THAT(refusal(), HasSubstr("has no camera.yaml and no freiburg1, 2 or 3 in its name"));
  EXPECT_DOUBLE_EQ(open({.camera = CameraChoice::fr3})->camera().fx, 535.4);
  const std::filesystem::path named = folder_.path() / "rgbd_dataset_freiburg1_room";
  std::filesystem::create_directory(named);
  for (const char* list : {"rgb.txt", "depth.txt"}) {
    std::filesystem::copy(folder_.path() / list, named / list);
  }
  EXPECT_DOUBLE_EQ(open_rgbd_folder(named, {})->camera().fx, 517.3);
}

TEST_F(RgbdFolder, WorksWithoutGroundTruthAndSaysSo) {
  std::filesystem::remove(folder_.path() / "groundtruth.txt");
  const auto source = open();
  EXPECT_TRUE(source->reference().empty());
  ASSERT_EQ(source->provenance().notes.size(), 1u);
  EXPECT_THAT(source->provenance().notes[0], HasSubstr("no groundtruth.txt"));
}

TEST_F(RgbdFolder, RefusesAFolderThatHoldsNoRecording) {
  EXPECT_THAT(refusal_of([&] { open_rgbd_folder(folder_.path() / "rgb", {}); }),
              HasSubstr("contains no recording"));
}

TEST_F(RgbdFolder, ReadsSevenScenesLayout) {
  TemporaryFolder native;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string from = fmt::format("{:04}.png", i);
    const auto to = [&](const char* what) {
      return native.path() / fmt::format("frame-{:06}.{}.png", i, what);
    };
    std::filesystem::copy(folder_.path() / "rgb" / from, to("color"));
    std::filesystem::copy(folder_.path() / "depth" / from, to("depth"));
  }
  native.file("frame-000000.pose.txt", "1 0 0 0.5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  native.file("camera.yaml", camera_yaml(room_->camera()));
  FolderOptions options;
  options.depth = DepthGeometry::registered;
  const auto source = open_rgbd_folder(native.path(), options);
  ASSERT_EQ(source->size(), 2u);
  EXPECT_DOUBLE_EQ(source->stamp(1), 1.0 / 30.0);
  ASSERT_EQ(source->reference().size(), 1u);
  EXPECT_DOUBLE_EQ(source->reference()[0].world_from_body.translation.x(), 0.5);
  std::string why;
  EXPECT_TRUE(source->read(1, why)) << why;
  options.depth = DepthGeometry::kinect;
  options.colour_focal = 507.0;
  EXPECT_EQ(open_rgbd_folder(native.path(), options)->camera().fx, 507.0);
}

TEST(PairImages, TakesTheNearestAndNoDepthImageTwice) {
  const std::vector<ListedImage> colour{{1.00, "a"}, {1.03, "b"}, {1.06, "c"}, {2.0, "d"}};
  const std::vector<ListedImage> depth{{1.01, "p"}, {1.05, "q"}};
  const auto pairs = pair_images(colour, depth, 0.02, "f");
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].grey, "f/a");
  EXPECT_EQ(pairs[0].depth, "f/p");
  EXPECT_EQ(pairs[1].grey, "f/c");  // closer to q than b
  EXPECT_EQ(pairs[1].depth, "f/q");
}

TEST(RegisterDepth, MovesAPointToThePixelThatSeesIt) {
  CameraPair cameras;
  cameras.colour.fx = cameras.colour.fy = 500.0;
  cameras.depth.fx = cameras.depth.fy = 600.0;
  cameras.colour.cx = cameras.depth.cx = 320.0;
  cameras.colour.cy = cameras.depth.cy = 240.0;
  cameras.colour_from_depth.translation = {0.02, 0.0, 0.5};
  DepthImage depth(640, 480);
  depth.at(380, 300) = 2.0f;  // (0.2, 0.2, 2) m; from the colour camera (0.22, 0.2, 2.5)
  const DepthImage out = register_depth(depth, cameras);
  EXPECT_FLOAT_EQ(out.at(364, 280), 2.5f);
  EXPECT_EQ(std::count(out.pixels.begin(), out.pixels.end(), 0.0f), 640 * 480 - 1);
}

}  // namespace
}  // namespace loopbench::folder_test
