#include "datasets/rgbd/folder/image_list.hpp"

#include <cmath>

#include "datasets/formats/columns.hpp"

namespace loopbench::rgbd {

void require_inside(const TextFile& list, const Line& line, const std::string& file) {
  const std::filesystem::path path = std::filesystem::path(file).lexically_normal();
  if (path.is_relative() && *path.begin() != "..") return;
  throw list.error(line.number,
                   "'" + file + "' is outside of the folder of the list, expected a path below it");
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
