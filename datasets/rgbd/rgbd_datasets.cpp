#include "datasets/rgbd/rgbd_datasets.hpp"

#include "datasets/rgbd/opencv.hpp"

namespace loopbench::rgbd {

Sequence load_rendered_room(const RenderedRoomOptions& options, const FrontendHooks& hooks) {
  return run_frontend(*rendered_room(options.render), "rendered_room", options.frontend, hooks);
}

Sequence load_rgbd(const RgbdOptions& options, const DataRoot& root, const FrontendHooks& hooks) {
  const std::filesystem::path folder = root.find(options.path);
  const auto source = open_rgbd_folder(folder, options.folder);
  std::string name = options.name;
  if (name.empty()) name = std::filesystem::weakly_canonical(folder).filename().string();
  Sequence out = run_frontend(*source, name, options.frontend, hooks);
  out.provenance.licence = options.licence;
  return out;
}

std::vector<DatasetEntry> rgbd_datasets(const FrontendHooks& hooks) {
  std::vector<DatasetEntry> out{
      dataset<RenderedRoomOptions>("rendered_room",
                                   "RGB-D front end on rendered images of a synthetic room",
                                   [hooks](const RenderedRoomOptions& options, const DataRoot&) {
                                     return load_rendered_room(options, hooks);
                                   }),
      dataset<RgbdOptions>("rgbd",
                           "RGB-D front end on a folder of images",
                           [hooks](const RgbdOptions& options, const DataRoot& root) {
                             return load_rgbd(options, root, hooks);
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
