/// The datasets that begin with images: `rendered_room` and `rgbd`.
#pragma once

#include <string>
#include <vector>

#include "datasets/dataset.hpp"
#include "datasets/rgbd/folder/folder_source.hpp"
#include "datasets/rgbd/frontend.hpp"
#include "datasets/rgbd/render/render_options.hpp"

namespace loopbench {

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
  visit("path", o.path, "folder of the recording: TUM RGB-D, 7-Scenes or ICL-NUIM layout");
  visit("name", o.name, "of the sequence; empty: the folder's");
  visit("licence", o.licence, "of the data");
  fields(o.folder, visit);
  fields(o.frontend, visit);
}

/// Throws OptionError.
inline void check_combination(const RgbdOptions& options) {
  if (options.path.empty()) throw OptionError("path", "path: names no folder");
}

/// Images of a room that does not exist, tracked. Throws InputError when nothing can be tracked.
Sequence load_rendered_room(const RenderedRoomOptions& options, const FrontendHooks& hooks = {});

/// A recording on disk, tracked. Throws InputError: see open_rgbd_folder() and run_frontend().
Sequence load_rgbd(const RgbdOptions& options,
                   const DataRoot& root,
                   const FrontendHooks& hooks = {});

/// Both, for the catalogue.
std::vector<DatasetEntry> rgbd_datasets(const FrontendHooks& hooks);

}  // namespace loopbench
