#include <cmath>

#include "datasets/images/folder/layouts.hpp"
#include "datasets/images/folder/read_image.hpp"
#include "datasets/images/frames/camera.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace loopbench {

using namespace rgbd;

void fuzz_camera(const std::filesystem::path& file) {
  unless_rejected([&] {
    const Camera camera = read_camera(file);
    check_holds(camera.width > 0 && camera.height > 0, "positive size");
    check_holds(camera.fx > 0.0 && camera.fy > 0.0, "positive focal lengths");
    check_holds(camera.cx >= 0.0 && camera.cx < camera.width, "principal point in the image");
    check_holds(camera.cy >= 0.0 && camera.cy < camera.height, "principal point in the image");
    check_holds(std::isfinite(camera.depth_scale) && camera.depth_scale > 0.0, "depth scale");
  });
}

void fuzz_image_list(const std::filesystem::path& file) {
  unless_rejected([&] {
    const std::vector<ListedImage> list = read_image_list(file);
    check_holds(!list.empty(), "images");
    for (std::size_t i = 1; i < list.size(); ++i) {
      check_holds(list[i - 1].stamp < list[i].stamp, "stamps increase");
    }
    pair_images(list, list, 0.02, "folder");
  });
}

/// The input is every text file of a recording, in each layout.
void fuzz_layout(const std::filesystem::path& file) {
  const std::string bytes = fuzz_bytes(file);
  const std::filesystem::path folder = fuzz_folder();
  for (const char* name : {"rgb.txt",
                           "depth.txt",
                           "groundtruth.txt",
                           "frame-000000.pose.txt",
                           "frame-000000.color.png",
                           "frame-000000.depth.png"}) {
    fuzz_file(folder, name, bytes);
  }
  FolderOptions options;
  options.camera = CameraChoice::fr1;
  unless_rejected([&] { read_tum_layout(folder, options); });
  unless_rejected([&] { read_seven_scenes_layout(folder, FolderOptions{}); });
  std::filesystem::remove_all(folder);
}

void fuzz_image(const std::filesystem::path& file) {
  unless_rejected([&] { read_grey(file); });
  unless_rejected([&] { read_depth(file); });
}

}  // namespace loopbench
