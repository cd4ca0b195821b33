// Source: Handa et al. 2014, ICL-NUIM, "TUM RGB-D compatible PNGs" and its page of conventions.
#include <fmt/format.h>

#include <algorithm>

#include "datasets/formats/columns.hpp"
#include "datasets/formats/formats.hpp"
#include "datasets/formats/text_file.hpp"
#include "datasets/rgbd/folder/layouts.hpp"

namespace loopbench::rgbd {
namespace {

namespace fs = std::filesystem;

/// fy is published as -480, because y points up in ICL-NUIM.
Camera icl_nuim_camera() {
  Camera out;
  out.fx = 481.2;
  out.fy = 480.0;
  return out;
}

/// Converts a pose from axes with y up to axes with y down.
Pose with_y_down(const Pose& pose) {
  const Vector3 mirror(1.0, -1.0, 1.0);
  const Matrix3 R = mirror.asDiagonal() * pose.rotation.toRotationMatrix() * mirror.asDiagonal();
  return {Rotation(Eigen::Quaterniond(R).normalized()), mirror.cwiseProduct(pose.translation)};
}

/// Returns the first file *.gt.freiburg by name ("livingRoom0.gt.freiburg"); empty if there is
/// none.
fs::path icl_nuim_truth(const fs::path& folder) {
  fs::path out;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(".gt.freiburg") && (out.empty() || entry.path() < out)) out = entry.path();
  }
  return out;
}

}  // namespace

bool is_icl_nuim(const fs::path& folder) {
  return fs::exists(folder / "associations.txt") && !fs::exists(folder / "rgb.txt");
}

Recording read_icl_nuim_layout(const fs::path& folder, const FolderOptions& options) {
  Recording out;
  out.camera = icl_nuim_camera();
  const fs::path camera = folder / "camera.yaml";
  if (fs::exists(camera)) {
    out.camera = read_camera(regular(camera));
    out.lists.push_back(camera);
  }
  TextFile list(regular(folder / "associations.txt"));
  out.lists.push_back(folder / "associations.txt");
  Line line;
  double previous = -1.0;
  while (list.next(line)) {
    Columns columns(list, line);
    columns.number("number of the depth image");
    const std::string depth(columns.word());
    const double number = columns.number("number of the colour image");
    const std::string colour(columns.word());
    if (depth.empty() || colour.empty() || !columns.done()) {
      throw list.error(line.number, "expected four columns: number depth number colour");
    }
    require_inside(list, line, depth);
    require_inside(list, line, colour);
    if (!(number > previous)) {
      throw list.error(line.number, "image number does not increase, expected increasing numbers");
    }
    previous = number;
    out.frames.push_back({number / options.rate, folder / colour, folder / depth});
  }
  if (out.frames.empty())
    throw list.error(0, "lists no image, expected lines of number depth number colour");
  const fs::path truth = icl_nuim_truth(folder);
  if (truth.empty()) {
    out.notes.emplace_back("no *.gt.freiburg: no evaluation against a reference");
    return out;
  }
  out.lists.push_back(truth);
  out.reference_file = truth;
  ReadOptions read_options;
  read_options.format = Format::tum;
  for (const StampedPose& pose : read_trajectory(regular(truth), read_options)) {
    out.reference.push_back({pose.stamp / options.rate, with_y_down(pose.world_from_body)});
  }
  return out;
}

}  // namespace loopbench::rgbd
