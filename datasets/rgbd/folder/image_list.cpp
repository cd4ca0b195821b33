#include "datasets/rgbd/folder/image_list.hpp"

#include <cmath>

#include "datasets/formats/columns.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

std::vector<ListedImage> read_image_list(const std::filesystem::path& list) {
  TextFile file(list);
  std::vector<ListedImage> out;
  Line line;
  while (file.next(line)) {
    Columns columns(file, line);
    ListedImage image;
    image.stamp = columns.number("stamp");
    image.file = columns.word();
    if (image.file.empty() || !columns.done()) {
      throw file.error(line.number, "expected two columns, `stamp file`");
    }
    if (!out.empty() && !(image.stamp > out.back().stamp)) {
      throw file.error(line.number, "stamp does not increase");
    }
    out.push_back(std::move(image));
  }
  if (out.empty()) throw file.error(0, "lists no image, expected lines of `stamp file`");
  return out;
}

std::vector<ImagePair> pair_images(const std::vector<ListedImage>& colour,
                                   const std::vector<ListedImage>& depth,
                                   double gap,
                                   const std::filesystem::path& folder) {
  std::vector<ImagePair> out;
  std::size_t taken = depth.size();  // depth image of the last pair
  double taken_gap = 0.0;
  std::size_t k = 0;
  for (const ListedImage& image : colour) {
    const auto apart = [&](std::size_t i) { return std::abs(depth[i].stamp - image.stamp); };
    while (k + 1 < depth.size() && apart(k + 1) < apart(k)) ++k;
    if (depth.empty() || apart(k) > gap) continue;
    if (k == taken) {
      if (apart(k) >= taken_gap) continue;
      out.pop_back();
    }
    out.push_back({image.stamp, folder / image.file, folder / depth[k].file});
    taken = k;
    taken_gap = apart(k);
  }
  return out;
}

}  // namespace loopbench
