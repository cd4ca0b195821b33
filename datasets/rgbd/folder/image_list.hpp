/// Lists of image files by time, and which colour image goes with which depth image.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace loopbench {

struct ListedImage {
  double stamp = 0.0;  ///< [s]
  std::string file;    ///< as the list names it
};

/// Lines `stamp file`, TUM's rgb.txt. Throws InputError with file and line: not two columns, a
/// stamp that does not increase, a list without images.
std::vector<ListedImage> read_image_list(const std::filesystem::path& list);

struct ImagePair {
  double stamp = 0.0;          ///< of the colour image [s]
  std::filesystem::path grey;  ///< colour or grey
  std::filesystem::path depth;
};

/// Every colour image with the depth image nearest in time, when it is no farther than `gap` [s];
/// of two that want the same depth image the nearer has it. Paths are put behind `folder`.
/// O(colour + depth).
std::vector<ImagePair> pair_images(const std::vector<ListedImage>& colour,
                                   const std::vector<ListedImage>& depth,
                                   double gap,
                                   const std::filesystem::path& folder);

}  // namespace loopbench
