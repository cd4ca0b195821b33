/// The datasets from images: `rendered_room` and `rgbd`.
#pragma once

#include <string>
#include <vector>

#include "datasets/dataset.hpp"
#include "datasets/rgbd/folder/folder_source.hpp"
#include "datasets/rgbd/frontend.hpp"
#include "datasets/rgbd/render/rendered_room.hpp"

namespace loopbench::rgbd {

struct RenderedRoomOptions {
  RenderOptions render;
  FrontendOptions frontend;
};

template <class Visit>
void fields(RenderedRoomOptions& o, Visit visit) {
  fields(o.render, visit);
  fields(o.frontend, visit);
}

struct RgbdOptions {
  std::string path;
  std::string name;
  std::string licence;
  FolderOptions folder;
  FrontendOptions frontend;
};

template <class Visit>
void fields(RgbdOptions& o, Visit visit) {
  visit("path", o.path, "folder of the recording in TUM RGB-D, 7-Scenes or ICL-NUIM layout");
  visit("name", o.name, "name of the sequence; empty: name of the folder");
  visit("licence", o.licence, "licence of the data, free text copied to the results");
  fields(o.folder, visit);
  fields(o.frontend, visit);
}

/// Throws OptionError.
inline void check_combination(const RgbdOptions& options) {
  if (options.path.empty())
    throw OptionError("path", "path: is empty, expected the folder of a recording");
}

/// Renders images of a synthetic room and runs the front end. Throws InputError, see
/// run_frontend().
Sequence load_rendered_room(const RenderedRoomOptions& options, const FrontendHooks& hooks = {});

/// Runs the front end on a recording. Throws InputError, see open_rgbd_folder() and run_frontend().
Sequence load_rgbd(const RgbdOptions& options,
                   const DataRoot& root,
                   const FrontendHooks& hooks = {});

/// Entries of both datasets.
std::vector<DatasetEntry> rgbd_datasets(const FrontendHooks& hooks);

}  // namespace loopbench::rgbd
