// Source: Shotton et al. 2013, README of the 7-Scenes dataset.
#include <fmt/format.h>

#include "datasets/columns/columns.hpp"
#include "datasets/columns/text_file.hpp"
#include "datasets/images/folder/layouts.hpp"
#include "datasets/images/folder/register_depth.hpp"

namespace loopbench::rgbd {
namespace {

namespace fs = std::filesystem;

fs::path frame_file(const fs::path& folder, std::size_t index, const char* suffix) {
  return folder / fmt::format("frame-{:06}.{}", index, suffix);
}

/// Reads world_from_camera as a 4 x 4 matrix.
Pose read_pose(const fs::path& path) {
  TextFile file(regular(path));
  Eigen::Matrix4d T;
  Line line;
  for (int row = 0; row < 4; ++row) {
    if (!file.next(line)) throw file.error(file.lines(), "expected a 4 x 4 matrix");
    Columns columns(file, line);
    for (int column = 0; column < 4; ++column) T(row, column) = columns.number("matrix entry");
    if (!columns.done()) throw file.error(line.number, "expected a 4 x 4 matrix");
  }
  const Matrix3 R = T.topLeftCorner<3, 3>();
  if ((R * R.transpose() - Matrix3::Identity()).cwiseAbs().maxCoeff() > 1e-2) {
    throw file.error(0, "rotation is not orthonormal, expected a deviation of at most 0.01");
  }
  return {Rotation(Eigen::Quaterniond(R).normalized()), T.topRightCorner<3, 1>()};
}

}  // namespace

bool is_seven_scenes(const fs::path& folder) {
  return fs::exists(frame_file(folder, 0, "color.png"));
}

Recording read_seven_scenes_layout(const fs::path& folder, const FolderOptions& options) {
  Recording out;
  out.camera = unregistered_kinect().depth;
  const fs::path camera = folder / "camera.yaml";
  if (fs::exists(camera)) {
    out.camera = read_camera(regular(camera));
    out.lists.push_back(camera);
  }
  std::size_t poses = 0;
  for (std::size_t k = 0; fs::exists(frame_file(folder, k, "color.png")); ++k) {
    const double stamp = static_cast<double>(k) / options.rate;
    out.frames.push_back(
        {stamp, frame_file(folder, k, "color.png"), frame_file(folder, k, "depth.png")});
    const fs::path pose = frame_file(folder, k, "pose.txt");
    if (!fs::exists(pose)) continue;
    ++poses;
    out.lists.push_back(pose);
    out.reference.push_back({stamp, read_pose(pose)});
  }
  if (poses < out.frames.size()) {
    out.notes.push_back(
        fmt::format("{} of {} frames have no pose", out.frames.size() - poses, out.frames.size()));
  }
  return out;
}

}  // namespace loopbench::rgbd
