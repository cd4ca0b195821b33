/// What the layouts of recordings have in common, and a reader for each.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "datasets/rgbd/camera.hpp"
#include "datasets/rgbd/folder/folder_source.hpp"
#include "datasets/rgbd/folder/image_list.hpp"

namespace loopbench {

struct Recording {
  Camera camera = {};
  std::vector<ImagePair> frames = {};
  Trajectory reference = {};                      ///< world_from_camera; may be empty
  std::filesystem::path reference_file = {};      ///< empty: none, or a file for each frame
  std::vector<std::filesystem::path> lists = {};  ///< every text file read
  std::vector<std::string> notes = {};
};

/// Throws InputError.
Recording read_tum_layout(const std::filesystem::path& folder, const FolderOptions& options);

bool is_seven_scenes(const std::filesystem::path& folder);
/// Throws InputError.
Recording read_seven_scenes_layout(const std::filesystem::path& folder,
                                   const FolderOptions& options);

bool is_icl_nuim(const std::filesystem::path& folder);
/// Stamps are the numbers of the images over the rate; the reference, written with y up, is
/// mirrored. Throws InputError.
Recording read_icl_nuim_layout(const std::filesystem::path& folder, const FolderOptions& options);

}  // namespace loopbench
