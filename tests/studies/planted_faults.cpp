// Plants each fault of metrics/doctor in every real sequence and prints how often it is found, and
// how often a finding is reported on the unmodified data:
//   build/release/tests/studies/planted_faults DATA > results/doctor/README.md
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>

#include "datasets/formats/formats.hpp"
#include "metrics/doctor/closure_checks.hpp"
#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/diagnose.hpp"
#include "metrics/numerics/euler.hpp"
#include "tests/studies/planted_edges.hpp"

using namespace loopbench;
using namespace loopbench::metrics;
namespace fs = std::filesystem;

namespace {

struct Recording {
  std::string reference_name, estimate_name;
  Trajectory reference, estimate;
  bool has_stamps = true;
};

struct PlantedFault {
  std::string name;
  Fault fault;
  std::function<void(Recording&)> plant;
};

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
Pose exchanged(const Pose& p) {
  return {p.rotation, {p.translation.y(), p.translation.x(), p.translation.z()}};
}

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
      {"estimate's x and y exchanged", Fault::axes, each_pose(false, exchanged)},
      {"estimate's axes y z x", Fault::axes, each_pose(false, permuted)},
      {"estimate inverted", Fault::inverted_poses, each_pose(false, inverted)},
      {"reference inverted", Fault::inverted_poses, each_pose(true, inverted)},
      {"estimate without scale (x 0.4)", Fault::scale, each_pose(false, lengths_times(0.4))},
      {"reference and estimate exchanged", Fault::swapped, [](Recording& r) {
         std::swap(r.reference, r.estimate);
         std::swap(r.reference_name, r.estimate_name);
       }}};
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

/// Every estimate next to a reference, sorted by path. Rows of KITTI files are scans of both files.
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

std::vector<InputFinding> findings(const Recording& r) {
  return diagnose(r.reference, r.estimate, r.reference_name, r.estimate_name, r.has_stamps);
}

bool has(const std::vector<InputFinding>& all, Fault fault) {
  return std::ranges::any_of(all, [&](const InputFinding& f) { return f.fault == fault; });
}

/// Root mean square difference of the angles that both trajectories turn within a second [deg].
double turn_difference(const Recording& r, double offset) {
  const CommonPoses poses = common_poses(r.reference, r.estimate, offset, 2000);
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0, j = 0; i < poses.stamps.size(); ++i) {
    while (j < poses.stamps.size() && poses.stamps[j] < poses.stamps[i] + 1.0) ++j;
    if (j == poses.stamps.size()) break;
    const auto angle = [&](const std::vector<Pose>& list) {
      return list[i].rotation.angularDistance(list[j].rotation);
    };
    squares += std::pow(angle(poses.reference) - angle(poses.estimate), 2);
    ++count;
  }
  return 180.0 / M_PI * std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, count)));
}

/// Whether a finding on unmodified data is confirmed by other means; appends these to `evidence`.
bool is_confirmed(const Recording& r, const InputFinding& finding, std::string& evidence) {
  if (finding.fault == Fault::scale) return is_monocular(r);
  if (finding.fault != Fault::time_offset) return false;
  const double before = turn_difference(r, 0.0);
  const double after = turn_difference(r, finding.value);
  evidence = fmt::format(
      ". Turns within a second differ by {:.2f} deg as read, by {:.2f} deg with the offset",
      before,
      after);
  return after < 0.6 * before;
}

struct Tally {
  std::size_t found = 0;
  std::size_t all = 0;
  std::vector<std::string> missed;
};

void add_to(Tally& tally,
            const std::vector<InputFinding>& found,
            Fault fault,
            const std::string& name) {
  if (has(found, fault)) {
    ++tally.found;
    return;
  }
  tally.missed.push_back(name);
  for (const InputFinding& each : found) tally.missed.back() += "\n  found " + text(each);
}

void print_row(const std::string& name, Fault fault, const Tally& t) {
  fmt::print(
      "| {} | {} | {} of {} | {:.1f} |\n",
      name,
      fault_name(fault),
      t.found,
      t.all,
      100.0 * static_cast<double>(t.found) / static_cast<double>(std::max<std::size_t>(1, t.all)));
  for (const std::string& missed : t.missed) fmt::print(stderr, "missed: {}: {}\n", name, missed);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: planted_faults DATA\n");
    return 2;
  }
  const fs::path data = argv[1];
  const std::vector<Recording> all = recordings(data);
  const auto problems = graphs(data);
  std::size_t false_alarms = 0, checks = 0;
  std::vector<std::string> alarms;
  std::vector<std::vector<InputFinding>> unmodified;
  for (const Recording& r : all) {
    unmodified.push_back(findings(r));
    bool is_alarm = false;
    for (const InputFinding& f : unmodified.back()) {
      std::string evidence;
      const bool is_true = is_confirmed(r, f, evidence);
      alarms.push_back(fmt::format("{}: {}{}{}",
                                   fs::path(r.estimate_name).lexically_relative(data).string(),
                                   is_true ? "(true) " : "",
                                   text(f),
                                   evidence));
      is_alarm |= !is_true;
    }
    ++checks;
    false_alarms += is_alarm ? 1 : 0;
  }
  for (const auto& [name, problem] : problems) {
    const auto found = check_closures(problem);
    for (const InputFinding& f : found) alarms.push_back(name + ": " + text(f));
    ++checks;
    false_alarms += found.empty() ? 0 : 1;
  }
  fmt::print("| planted fault | finding | found | found [%] |\n| --- | --- | ---: | ---: |\n");
  Tally sum;
  const auto add = [&](const std::string& name, Fault fault, const Tally& tally) {
    print_row(name, fault, tally);
    sum.found += tally.found;
    sum.all += tally.all;
  };
  for (const PlantedFault& each : faults()) {
    Tally tally;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const bool needs_stamps = each.fault == Fault::time_offset;
      if (needs_stamps && !all[i].has_stamps) continue;
      // The unit of a monocular estimate is arbitrary.
      if (each.fault == Fault::length_unit && is_monocular(all[i])) continue;
      Recording planted = all[i];
      each.plant(planted);
      ++tally.all;
      add_to(tally, findings(planted), each.fault, all[i].estimate_name);
    }
    add(each.name, each.fault, tally);
  }
  for (const PlantedEdges& each : edge_faults()) {
    Tally tally;
    for (const auto& [name, problem] : problems) {
      Problem planted = problem;
      each.plant(planted);
      ++tally.all;
      add_to(tally, check_closures(planted), each.fault, name);
    }
    add(each.name, each.fault, tally);
  }
  fmt::print("| all | | {} of {} | {:.1f} |\n",
             sum.found,
             sum.all,
             100.0 * static_cast<double>(sum.found) / static_cast<double>(sum.all));
  fmt::print("\nUnmodified: {} of {} data sets have a wrong finding ({:.1f} %).\n\n",
             false_alarms,
             checks,
             100.0 * static_cast<double>(false_alarms) / static_cast<double>(checks));
  for (const std::string& alarm : alarms) fmt::print("- {}\n", alarm);
  return 0;
}
