#include "tests/studies/recordings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "datasets/core/se3.hpp"
#include "datasets/formats/formats.hpp"

namespace loopbench {

namespace fs = std::filesystem;

namespace {

Recording read(const fs::path& reference, const fs::path& estimate) {
  Recording out{reference.string(), estimate.string(), {}, {}, true, false};
  out.is_car = out.estimate_name.find("/kitti/") != std::string::npos;
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

namespace {

/// A smooth curve with three frequencies.
class Curve {
 public:
  Curve(std::mt19937& random, double amplitude, double slowest, double fastest) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (Wave& wave : waves_) {
      wave.amplitude = amplitude * (0.3 + unit(random));
      wave.frequency = slowest + (fastest - slowest) * unit(random);
      wave.phase = 2.0 * M_PI * unit(random);
    }
  }

  double at(double t) const {
    double out = 0.0;
    for (const Wave& w : waves_) out += w.amplitude * std::sin(w.frequency * t + w.phase);
    return out;
  }

 private:
  struct Wave {
    double amplitude = 0.0, frequency = 0.0, phase = 0.0;
  };
  Wave waves_[3];
};

/// Poses at a rate of 100 Hz.
Trajectory simulated_path(std::mt19937& random, bool is_car) {
  constexpr double kStep = 0.01, kDuration = 90.0;
  Trajectory out;
  if (is_car) {  // body axes forward, left, up
    const Curve yaw_rate(random, 0.25, 0.05, 0.4), speed(random, 2.0, 0.05, 0.5);
    const Curve tilt(random, 0.01, 0.5, 2.0);
    Pose pose;
    double yaw = 0.0;
    for (double t = 0.0; t < kDuration; t += kStep) {
      yaw += kStep * yaw_rate.at(t);
      pose.rotation = exp_so3({0, 0, yaw}) * exp_so3({tilt.at(t), tilt.at(t + 7.0), 0});
      pose.translation +=
          kStep * std::max(0.5, 8.0 + speed.at(t)) * (pose.rotation * Vector3(1, 0, 0));
      out.push_back({t, pose});
    }
    return out;
  }
  const Curve x(random, 1.2, 0.2, 1.2), y(random, 1.2, 0.2, 1.2), z(random, 0.5, 0.2, 1.2);
  const Curve roll(random, 0.25, 0.3, 1.5), pitch(random, 0.25, 0.3, 1.5),
      yaw(random, 0.9, 0.1, 0.7);
  for (double t = 0.0; t < kDuration; t += kStep) {
    const Rotation rotation =
        exp_so3({0, 0, yaw.at(t)}) * exp_so3({0, pitch.at(t), 0}) * exp_so3({roll.at(t), 0, 0});
    out.push_back({t, {rotation, {x.at(t), y.at(t), z.at(t)}}});
  }
  return out;
}

}  // namespace

std::vector<Recording> simulated_recordings(unsigned count) {
  std::vector<Recording> out;
  for (unsigned seed = 0; seed < count; ++seed) {
    std::mt19937 random(9000 + seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    const bool is_car = seed % 2 == 1;
    const auto noise = [&](double metres, double radians) {
      const auto vector = [&] { return Vector3(normal(random), normal(random), normal(random)); };
      return exp_se3(twist(metres * vector(), radians * vector()));
    };
    Recording r{
        "simulated/groundtruth.txt", fmt::format("simulated/{}.txt", seed), {}, {}, true, is_car};
    r.reference = simulated_path(random, is_car);
    const double start = 1.5e9 + 1000.0 * seed;
    for (StampedPose& pose : r.reference) pose.stamp += start;
    const std::size_t step = is_car ? 10 : 5;
    const double drift = is_car ? 0.004 : 0.001;  // of each step
    const Pose world = noise(3.0, 1.0);
    Pose estimated = world;
    for (std::size_t i = 0; i < r.reference.size(); i += step) {
      if (i > 0) {
        const Pose moved =
            r.reference[i - step].world_from_body.inverse() * r.reference[i].world_from_body;
        estimated = normalized(estimated * moved * noise(drift, 0.1 * drift));
      }
      r.estimate.push_back(
          {r.reference[i].stamp, normalized(estimated * noise(is_car ? 0.02 : 0.002, 0.001))});
    }
    out.push_back(std::move(r));
  }
  return out;
}

bool is_monocular(const Recording& r) {
  return r.estimate_name.find("mono") != std::string::npos ||
         r.estimate_name.find("orbslam_frames_evo") != std::string::npos;
}

}  // namespace loopbench
