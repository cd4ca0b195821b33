#include "harness/commands/traj/trajectory_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "datasets/core/fields.hpp"
#include "datasets/core/upper_median.hpp"
#include "harness/commands/files/named_trajectory.hpp"
#include "harness/sweep/text/counted.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::harness {
namespace {

using metrics::kDegrees;

double median_of(std::vector<double> values) { return upper_median(values); }

/// Speeds above twenty times the median and ten times the 95 % quantile are jumps.
void remark_jumps(TrajectorySummary& out, const std::vector<double>& speeds) {
  constexpr double kOverMedian = 20.0, kOverMost = 10.0;
  std::vector<double> sorted = speeds;
  std::ranges::sort(sorted);
  const double limit = std::max(kOverMedian * sorted[sorted.size() / 2],
                                kOverMost * sorted[sorted.size() * 95 / 100]);
  const auto jumps = std::ranges::count_if(speeds, [&](double v) { return v > limit; });
  if (jumps == 0 || limit <= 0.0) return;
  out.remarks.push_back(fmt::format("{} {} of up to {:.3g} m/s, the usual speed is {:.3g} m/s",
                                    jumps,
                                    jumps == 1 ? "jump with a speed" : "jumps with speeds",
                                    out.largest_speed,
                                    sorted[sorted.size() / 2]));
}

void remark_constants(TrajectorySummary& out, const Trajectory& poses) {
  if (lacks_rotations(poses)) out.remarks.push_back("positions without rotation");
  const Rotation& first = poses.front().world_from_body.rotation;
  const bool same_rotation = std::ranges::all_of(poses, [&](const StampedPose& p) {
    return p.world_from_body.rotation.coeffs() == first.coeffs();
  });
  if (same_rotation) out.remarks.push_back("all orientations are equal: positions only?");
  if (out.length == 0.0) out.remarks.push_back("all positions are equal");
}

}  // namespace

TrajectorySummary summarise(const std::string& name,
                            const TrajectoryFile& file,
                            const ReadFindings& findings) {
  TrajectorySummary out;
  const Trajectory& poses = file.poses;
  out.name = name;
  out.format = to_text(file.format);
  out.poses = poses.size();
  out.has_covariances = !file.covariances.empty();
  if (!findings.damage.empty()) out.remarks.push_back(findings.damage);
  if (findings.origin) out.remarks.push_back(to_text(*findings.origin));
  if (findings.without_fix > 0) {
    out.remarks.push_back(counted(findings.without_fix, "dropped row") + " without a fix");
  }
  for (const std::string& note : reading_notes(findings)) out.remarks.push_back(note);
  if (findings.repeated > 0) {
    out.remarks.push_back(counted(findings.repeated, "repeated stamp") + " dropped");
  }
  if (findings.off_unit > 1e-3) {
    out.remarks.push_back(
        fmt::format("quaternions deviate from unit norm by up to {:.2g}", findings.off_unit));
  }
  if (poses.empty()) return out;
  out.start = poses.front().stamp;
  out.end = poses.back().stamp;
  out.duration = out.end - out.start;
  out.length = path_length(poses);
  out.low = out.high = poses.front().world_from_body.translation;
  std::vector<double> intervals, speeds;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose& pose = poses[i].world_from_body;
    out.low = out.low.cwiseMin(pose.translation);
    out.high = out.high.cwiseMax(pose.translation);
    if (i == 0) continue;
    const Pose& before = poses[i - 1].world_from_body;
    const double interval = poses[i].stamp - poses[i - 1].stamp;
    const double angle =
        has_rotation(pose) ? kDegrees * angle_between(before.rotation, pose.rotation) : 0.0;
    intervals.push_back(interval);
    speeds.push_back((pose.translation - before.translation).norm() / interval);
    out.rotation += angle;
    out.largest_rotation_speed = std::max(out.largest_rotation_speed, angle / interval);
  }
  if (intervals.empty()) return out;
  const double interval_median = median_of(intervals);
  out.rate = 1.0 / interval_median;
  out.mean_speed = out.length / out.duration;
  out.largest_speed = *std::ranges::max_element(speeds);
  out.longest_interval = *std::ranges::max_element(intervals);
  out.gaps = static_cast<std::size_t>(std::ranges::count_if(intervals, [&](double interval) {
    return interval > std::max(10.0 * interval_median, 0.5);
  }));
  if (file.has_stamps) remark_jumps(out, speeds);
  remark_constants(out, poses);
  return out;
}

std::string text(const TrajectorySummary& s) {
  std::string out = fmt::format("{}\n", s.name);
  const auto line = [&](const char* what, const std::string& value) {
    out += fmt::format("  {:<16}{}\n", what, value);
  };
  line("format", s.format + (s.has_covariances ? ", with covariances" : ""));
  line("poses", fmt::format("{}", s.poses));
  if (s.poses > 0) {
    line("time", fmt::format("{:.6f} to {:.6f}, {:.3f} s", s.start, s.end, s.duration));
    line("distance", fmt::format("{:.3f} m, rotation {:.1f} deg", s.length, s.rotation));
    line("speed",
         fmt::format("mean {:.3f} m/s, largest {:.3f} m/s and {:.1f} deg/s",
                     s.mean_speed,
                     s.largest_speed,
                     s.largest_rotation_speed));
    line("rate",
         fmt::format(
             "{:.2f} Hz, longest interval {:.3f} s, {} gaps", s.rate, s.longest_interval, s.gaps));
    line("bounding box",
         fmt::format("x {:.3f}..{:.3f}, y {:.3f}..{:.3f}, z {:.3f}..{:.3f} m",
                     s.low.x(),
                     s.high.x(),
                     s.low.y(),
                     s.high.y(),
                     s.low.z(),
                     s.high.z()));
  }
  for (const std::string& remark : s.remarks) line("remark", remark);
  return out;
}

std::string json(const std::vector<TrajectorySummary>& summaries) {
  nlohmann::json out = nlohmann::json::array();
  for (const TrajectorySummary& s : summaries) {
    out.push_back({{"name", s.name},
                   {"format", s.format},
                   {"poses", s.poses},
                   {"start", s.start},
                   {"end", s.end},
                   {"duration", s.duration},
                   {"length", s.length},
                   {"rate", s.rate},
                   {"mean_speed", s.mean_speed},
                   {"largest_speed", s.largest_speed},
                   {"largest_rotation_speed", s.largest_rotation_speed},
                   {"longest_interval", s.longest_interval},
                   {"gaps", s.gaps},
                   {"rotation", s.rotation},
                   {"low", {s.low.x(), s.low.y(), s.low.z()}},
                   {"high", {s.high.x(), s.high.y(), s.high.z()}},
                   {"covariances", s.has_covariances},
                   {"remarks", s.remarks}});
  }
  return out.dump(2) + "\n";
}

}  // namespace loopbench::harness
