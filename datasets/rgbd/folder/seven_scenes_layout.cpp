// Source: Shotton et al. 2013, README of the 7-Scenes dataset.
#include <fmt/format.h>

#include "datasets/formats/columns.hpp"
#include "datasets/formats/text_file.hpp"
#include "datasets/rgbd/folder/layouts.hpp"

namespace loopbench {
namespace {

namespace fs = std::filesystem;

fs::path part(const fs::path& folder, std::size_t index, const char* what) {
  return folder / fmt::format("frame-{:06}.{}", index, what);
}

Camera kinect() {
  Camera out;
  out.fx = out.fy = 585.0;
  out.cx = 320.0;
  out.cy = 240.0;
  out.depth_scale = 1000.0;
  return out;
}

/// A 4 x 4 matrix, camera to world.
Pose read_pose(const fs::path& path) {
  TextFile file(path);
  Eigen::Matrix4d T;
  Line line;
  for (int row = 0; row < 4; ++row) {
    if (!file.next(line)) throw file.error(file.lines(), "expected a matrix of 4 x 4");
    Columns columns(file, line);
    for (int column = 0; column < 4; ++column) T(row, column) = columns.number("matrix entry");
    if (!columns.done()) throw file.error(line.number, "expected a matrix of 4 x 4");
  }
  const Matrix3 R = T.topLeftCorner<3, 3>();
  if ((R * R.transpose() - Matrix3::Identity()).cwiseAbs().maxCoeff() > 1e-2) {
    throw file.error(0, "the rotation is not orthonormal");
  }
  return {Rotation(Eigen::Quaterniond(R).normalized()), T.topRightCorner<3, 1>()};
}

}  // namespace

bool is_seven_scenes(const fs::path& folder) { return fs::exists(part(folder, 0, "color.png")); }

Recording read_seven_scenes_layout(const fs::path& folder, const FolderOptions& options) {
  Recording out;
  out.camera = kinect();
  const fs::path camera = folder / "camera.yaml";
  if (fs::exists(camera)) {
    out.camera = read_camera(camera);
    out.lists.push_back(camera);
  }
  std::size_t poses = 0;
  for (std::size_t k = 0; fs::exists(part(folder, k, "color.png")); ++k) {
    const double stamp = static_cast<double>(k) / options.rate;
    out.frames.push_back({stamp, part(folder, k, "color.png"), part(folder, k, "depth.png")});
    const fs::path pose = part(folder, k, "pose.txt");
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

}  // namespace loopbench
