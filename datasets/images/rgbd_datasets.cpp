#include "datasets/images/rgbd_datasets.hpp"

#include "datasets/images/folder/folder_source.hpp"
#include "datasets/images/opencv.hpp"
#include "datasets/images/render/rendered_room.hpp"

namespace loopbench::rgbd {
namespace {

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
  visit("path", o.path, "folder of the recording in TUM RGB-D or 7-Scenes layout");
  visit("name", o.name, "name of the sequence; empty: name of the folder");
  visit("licence", o.licence, "licence of the data, free text copied to the results");
  fields(o.folder, visit);
  fields(o.frontend, visit);
}

/// Throws OptionError.
void check_combination(const RgbdOptions& options) {
  if (options.path.empty())
    throw OptionError("path", "path: is empty, expected the folder of a recording");
}

Sequence load_rendered_room(const RenderedRoomOptions& options, const FrontendProgress& progress) {
  return run_frontend(*rendered_room(options.render), "rendered_room", options.frontend, progress);
}

Sequence load_rgbd(const RgbdOptions& options,
                   const DataRoot& root,
                   const FrontendProgress& progress) {
  const std::filesystem::path folder = root.find(options.path);
  const auto source = open_rgbd_folder(folder, options.folder);
  std::string name = options.name;
  if (name.empty()) name = std::filesystem::weakly_canonical(folder).filename().string();
  Sequence out = run_frontend(*source, name, options.frontend, progress);
  out.provenance.licence = options.licence;
  return out;
}

}  // namespace

std::vector<DatasetEntry> rgbd_datasets(const FrontendProgress& progress) {
  std::vector<DatasetEntry> out{
      dataset<RenderedRoomOptions>("rendered_room",
                                   "RGB-D front end on rendered images of a synthetic room",
                                   [progress](const RenderedRoomOptions& options, const DataRoot&) {
                                     return load_rendered_room(options, progress);
                                   }),
      dataset<RgbdOptions>("rgbd",
                           "RGB-D front end on a folder of images",
                           [progress](const RgbdOptions& options, const DataRoot& root) {
                             return load_rgbd(options, root, progress);
                           }),
  };
  // Tracking takes minutes; reading the image lists and the intrinsics is sufficient.
  out[0].inspect = [](const Params&, const DataRoot&) {};
  out[1].inspect = [](const Params& given, const DataRoot& root) {
    const RgbdOptions options = with(RgbdOptions{}, given);
    open_rgbd_folder(root.find(options.path), options.folder);
  };
  if (!has_opencv()) {
    for (DatasetEntry& entry : out) entry.missing_part = kWithoutOpencv;
  }
  return out;
}

}  // namespace loopbench::rgbd
