/// Readers for the layouts of recordings, and their lists of stamped image files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "datasets/images/folder/folder_source.hpp"
#include "datasets/images/frames/camera.hpp"

namespace loopbench::rgbd {

struct ListedImage {
  double stamp = 0.0;  ///< [s]
  std::string file;    ///< path as written in the list
};

/// Returns the file. Throws InputError if it exists and is no regular file: nobody named it, so a
/// pipe is a mistake, and its reader would wait for a writer. Follows symbolic links.
std::filesystem::path regular(const std::filesystem::path& file);

/// Reads lines of `stamp file` (rgb.txt of TUM RGB-D). Throws InputError `file:line: what` for
/// another number of columns, a stamp that does not increase, a path outside of the list's folder,
/// and a list without images.
std::vector<ListedImage> read_image_list(const std::filesystem::path& list);

struct ImagePair {
  double stamp = 0.0;          ///< of the colour image [s]
  std::filesystem::path grey;  ///< colour or grey image
  std::filesystem::path depth;
};

/// Pairs each colour image with the nearest depth image in time, at most `gap` [s] away. Each depth
/// image is used once, for the nearest colour image. Paths are relative to `folder`. O(colour +
/// depth).
std::vector<ImagePair> pair_images(const std::vector<ListedImage>& colour,
                                   const std::vector<ListedImage>& depth,
                                   double gap,
                                   const std::filesystem::path& folder);

struct Recording {
  Camera camera = {};
  std::vector<ImagePair> frames = {};
  Trajectory reference = {};                      ///< world_from_camera; may be empty
  std::filesystem::path reference_file = {};      ///< empty: none, or one file per frame
  std::vector<std::filesystem::path> lists = {};  ///< every text file read
  std::vector<std::string> notes = {};
};

/// Throws InputError.
Recording read_tum_layout(const std::filesystem::path& folder, const FolderOptions& options);

bool is_seven_scenes(const std::filesystem::path& folder);
/// Throws InputError.
Recording read_seven_scenes_layout(const std::filesystem::path& folder,
                                   const FolderOptions& options);

}  // namespace loopbench::rgbd
