#include "tests/studies/planted_poses.hpp"

#include <algorithm>
#include <cmath>

#include "datasets/formats/formats.hpp"
#include "metrics/numerics/euler.hpp"

namespace loopbench {

using namespace metrics;
namespace fs = std::filesystem;

namespace {

template <class Change>
std::function<void(Recording&)> each_pose(bool of_reference, Change change) {
  return [=](Recording& r) {
    for (auto& [stamp, pose] : of_reference ? r.reference : r.estimate) pose = change(pose);
  };
}

std::function<void(Recording&)> later(double seconds) {
  return [=](Recording& r) {
    for (StampedPose& pose : r.estimate) pose.stamp += seconds;
  };
}

Pose wxyz_as_xyzw(const Pose& p) {
  const Rotation& q = p.rotation;
  return {Rotation(q.z(), q.w(), q.x(), q.y()), p.translation};
}

std::function<Pose(const Pose&)> angles_times(double factor) {
  return [=](const Pose& p) -> Pose {
    const Euler e = euler(p.rotation);
    const auto about = [&](double angle, const Vector3& axis) {
      return exp_so3(factor * angle * axis);
    };
    return {about(e.yaw, Vector3::UnitZ()) * about(e.pitch, Vector3::UnitY()) *
                about(e.roll, Vector3::UnitX()),
            p.translation};
  };
}

std::function<Pose(const Pose&)> lengths_times(double factor) {
  return [=](const Pose& p) -> Pose { return {p.rotation, factor * p.translation}; };
}

Pose inverted(const Pose& p) { return p.inverse(); }
Pose mirrored(const Pose& p) {  // not y, which is up in KITTI: a car moves in a plane
  return {p.rotation, {-p.translation.x(), p.translation.y(), p.translation.z()}};
}
Pose permuted(const Pose& p) {
  return {p.rotation, {p.translation.y(), p.translation.z(), p.translation.x()}};
}
Pose x_and_y_exchanged(const Pose& p) {
  return {p.rotation, {p.translation.y(), p.translation.x(), p.translation.z()}};
}

/// The axes of a camera (right, down, forward) for those of a vehicle (forward, left, up).
Pose with_body_axes(const Pose& pose) {
  return {pose.rotation * Rotation(0.5, -0.5, 0.5, -0.5), pose.translation};
}

/// A lever arm as of a marker on a camera, or of another sensor on a car.
void to_another_body(Recording& r) {
  const bool is_car = r.estimate_name.find("/kitti/") != std::string::npos;
  const Pose other{Rotation::Identity(), (is_car ? 4.0 : 1.0) * Vector3(0.3, -0.2, 0.25)};
  for (StampedPose& pose : r.estimate) pose.world_from_body = pose.world_from_body * other;
}

Recording read(const fs::path& reference, const fs::path& estimate) {
  Recording out{reference.string(), estimate.string(), {}, {}, true};
  const auto load = [&](const fs::path& file) {
    ReadOptions options;
    options.repeats = Repeats::keep_last;
    out.has_stamps &= detect_format(file) != Format::kitti;
    return read_trajectory(file, options);
  };
  out.reference = load(reference);
  out.estimate = load(estimate);
  return out;
}

}  // namespace

std::vector<PlantedFault> faults() {
  constexpr double kDegree = 180.0 / M_PI;
  return {
      {"estimate 0.25 s late", Fault::time_offset, later(0.25)},
      {"estimate 1.5 s early", Fault::time_offset, later(-1.5)},
      {"clocks without overlap", Fault::time_offset, later(1e5)},
      {"estimate's quaternions w x y z", Fault::quaternion_order, each_pose(false, wxyz_as_xyzw)},
      {"reference's quaternions w x y z", Fault::quaternion_order, each_pose(true, wxyz_as_xyzw)},
      {"degrees for radians", Fault::angle_unit, each_pose(false, angles_times(kDegree))},
      {"radians for degrees", Fault::angle_unit, each_pose(false, angles_times(1.0 / kDegree))},
      {"estimate in millimetres", Fault::length_unit, each_pose(false, lengths_times(1000.0))},
      {"reference in millimetres", Fault::length_unit, each_pose(true, lengths_times(1000.0))},
      {"estimate's x mirrored", Fault::axes, each_pose(false, mirrored)},
      {"estimate's x and y exchanged", Fault::axes, each_pose(false, x_and_y_exchanged)},
      {"estimate's axes y z x", Fault::axes, each_pose(false, permuted)},
      {"estimate inverted", Fault::inverted_poses, each_pose(false, inverted)},
      {"reference inverted", Fault::inverted_poses, each_pose(true, inverted)},
      {"estimate without scale (x 0.4)", Fault::scale, each_pose(false, lengths_times(0.4))},
      {"estimate of another body (0.44 m; cars 1.75 m)", Fault::lever_arm, to_another_body},
      {"estimate's body with axes z, -x, -y",
       Fault::body_rotation,
       each_pose(false, with_body_axes)},
      {"reference and estimate exchanged", Fault::swapped, [](Recording& r) {
         std::swap(r.reference, r.estimate);
         std::swap(r.reference_name, r.estimate_name);
       }}};
}

std::vector<Recording> recordings(const fs::path& data) {
  std::vector<Recording> out;
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(data)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    const std::string path = file.string();
    const fs::path folder = file.parent_path();
    const bool is_text = file.extension() == ".txt";
    const std::string name = file.filename().string();
    if (!is_text || name.starts_with("groundtruth") || name.starts_with("gt_")) continue;
    if (path.find("/tum_rgbd/") != path.npos) {
      out.push_back(read(folder / "groundtruth.txt", file));
    } else if (path.find("/kitti/") != path.npos) {
      const bool is_kitti = detect_format(file) == Format::kitti;
      const fs::path truth = folder / (is_kitti ? "gt_poses.txt" : "gt_tum.txt");
      if (!fs::exists(truth)) continue;
      Recording recording = read(truth, file);
      if (!is_kitti || recording.reference.size() == recording.estimate.size()) {
        out.push_back(std::move(recording));
      }
    } else if (path.find("/euroc/") != path.npos) {
      out.push_back(read(folder / "state_groundtruth_estimate0.csv", file));
    } else if (path.find("/euroc_repeats/vislam") != path.npos && name < "3") {
      out.push_back(
          read(data / "euroc_repeats/truth" / (folder.filename().string() + ".csv"), file));
    }
  }
  return out;
}

bool is_monocular(const Recording& r) {
  return r.estimate_name.find("mono") != std::string::npos ||
         r.estimate_name.find("orbslam_frames_evo") != std::string::npos;
}

}  // namespace loopbench
