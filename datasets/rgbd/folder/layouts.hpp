/// Readers for the layouts of recordings.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "datasets/rgbd/camera.hpp"
#include "datasets/rgbd/folder/folder_source.hpp"
#include "datasets/rgbd/folder/image_list.hpp"

namespace loopbench::rgbd {

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

bool is_icl_nuim(const std::filesystem::path& folder);
/// Stamps are image numbers divided by the rate. The reference is converted from y up to y down.
/// Throws InputError.
Recording read_icl_nuim_layout(const std::filesystem::path& folder, const FolderOptions& options);

}  // namespace loopbench::rgbd
