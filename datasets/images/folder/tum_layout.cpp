#include <fmt/format.h>

#include <cmath>

#include "datasets/columns/columns.hpp"
#include "datasets/columns/text_file.hpp"
#include "datasets/formats/formats.hpp"
#include "datasets/images/folder/layouts.hpp"

namespace loopbench::rgbd {
namespace {

namespace fs = std::filesystem;

/// Returns the number of the TUM camera in the folder name, 0 if there is none.
int freiburg_in(const fs::path& folder) {
  const std::string name = fs::weakly_canonical(folder).filename().string();
  for (int k = 1; k <= 3; ++k) {
    for (const char* prefix : {"freiburg", "fr"}) {
      if (name.find(prefix + std::to_string(k)) != std::string::npos) return k;
    }
  }
  return 0;
}

Camera camera_for(const fs::path& folder, CameraChoice choice, std::vector<fs::path>& lists) {
  if (choice == CameraChoice::fr1) return tum_camera(1);
  if (choice == CameraChoice::fr2) return tum_camera(2);
  if (choice == CameraChoice::fr3) return tum_camera(3);
  const fs::path file = folder / "camera.yaml";
  if (choice == CameraChoice::file || fs::exists(file)) {
    lists.push_back(file);
    return read_camera(regular(file));
  }
  if (const int k = freiburg_in(folder)) return tum_camera(k);
  throw input_error(
      folder.string(),
      0,
      "has no camera.yaml and no freiburg1, 2 or 3 in its name; set the option camera "
      "to fr1, fr2 or fr3");
}

/// Throws InputError `list:line: what` unless `file`, a path in a list, is relative and stays below
/// the folder of the list. Symbolic links in that folder can still lead elsewhere.
void require_inside(const TextFile& list, const Line& line, const std::string& file) {
  const std::filesystem::path path = std::filesystem::path(file).lexically_normal();
  if (path.is_relative() && *path.begin() != "..") return;
  throw list.error(line.number,
                   "'" + file + "' is outside of the folder of the list, expected a path below it");
}

}  // namespace

Recording read_tum_layout(const fs::path& folder, const FolderOptions& options) {
  Recording out;
  out.camera = camera_for(folder, options.camera, out.lists);
  const std::vector<ListedImage> colour = read_image_list(folder / "rgb.txt");
  const std::vector<ListedImage> depth = read_image_list(folder / "depth.txt");
  out.lists.push_back(folder / "rgb.txt");
  out.lists.push_back(folder / "depth.txt");
  out.frames = pair_images(colour, depth, options.pair_gap, folder);
  if (out.frames.empty()) {
    throw input_error((folder / "depth.txt").string(),
                      0,
                      fmt::format("found no depth image within pair_gap = {} s of a colour image",
                                  options.pair_gap));
  }
  if (out.frames.size() < colour.size()) {
    out.notes.push_back(fmt::format("{} of {} colour images have no depth image within {} s",
                                    colour.size() - out.frames.size(),
                                    colour.size(),
                                    options.pair_gap));
  }
  const fs::path truth = folder / "groundtruth.txt";
  if (fs::exists(truth)) {
    out.lists.push_back(truth);
    ReadOptions read_options;
    read_options.format = Format::tum;
    read_options.repeats = Repeats::keep_first;
    out.reference = read_trajectory(regular(truth), read_options);
    out.reference_file = truth;
  } else {
    out.notes.emplace_back("no groundtruth.txt: no evaluation against a reference");
  }
  return out;
}

std::filesystem::path regular(const std::filesystem::path& file) {
  std::error_code none;
  const std::filesystem::file_status status = std::filesystem::status(file, none);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return file;
  throw input_error(file.string(), 0, "is not a regular file, expected a text file");
}

std::vector<ListedImage> read_image_list(const std::filesystem::path& list) {
  TextFile file(regular(list));
  std::vector<ListedImage> out;
  Line line;
  while (file.next(line)) {
    Columns columns(file, line);
    ListedImage image;
    image.stamp = columns.number("stamp");
    image.file = columns.word();
    if (image.file.empty() || !columns.done()) {
      throw file.error(line.number, "expected two columns: stamp file");
    }
    require_inside(file, line, image.file);
    if (!out.empty() && !(image.stamp > out.back().stamp)) {
      throw file.error(line.number, "stamp does not increase, expected increasing stamps");
    }
    out.push_back(std::move(image));
  }
  if (out.empty()) throw file.error(0, "lists no image, expected lines of stamp file");
  return out;
}

std::vector<ImagePair> pair_images(const std::vector<ListedImage>& colour,
                                   const std::vector<ListedImage>& depth,
                                   double gap,
                                   const std::filesystem::path& folder) {
  std::vector<ImagePair> out;
  std::size_t last_depth = depth.size();  // depth image of the last pair
  double last_gap = 0.0;
  std::size_t k = 0;
  for (const ListedImage& image : colour) {
    const auto time_gap = [&](std::size_t i) { return std::abs(depth[i].stamp - image.stamp); };
    while (k + 1 < depth.size() && time_gap(k + 1) < time_gap(k)) ++k;
    if (depth.empty() || time_gap(k) > gap) continue;
    if (k == last_depth) {
      if (time_gap(k) >= last_gap) continue;
      out.pop_back();
    }
    out.push_back({image.stamp, folder / image.file, folder / depth[k].file});
    last_depth = k;
    last_gap = time_gap(k);
  }
  return out;
}

}  // namespace loopbench::rgbd
