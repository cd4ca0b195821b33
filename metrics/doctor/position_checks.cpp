#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "metrics/doctor/pair_checks.hpp"
#include "metrics/numerics/average.hpp"

namespace loopbench::metrics {
namespace {

double distance(const Trajectory& poses, std::size_t i, std::size_t j) {
  return (poses[j].world_from_body.translation - poses[i].world_from_body.translation).norm();
}

/// The poses of a file, those of the other file at the same time, and what steps of the file are.
struct Steps {
  Paired poses;          ///< `reference` is the other file
  double scale = 1.0;    ///< of the file, over the other one
  double largest = 0.0;  ///< longer steps than the other file's by this are jumps [m]

  Steps(const Trajectory& file, const Trajectory& other)
      : poses(interpolate_reference(other, file, longest_gap(other), 0.0)) {
    constexpr double kOverUsual = 20.0, kOfSpread = 0.02, kMost = 0.85;
    const std::size_t n = poses.estimate.size(), few = n / 200 + 1;
    if (n < kFewestCommonPoses) return;
    std::vector<double> of_file, of_other, differences;
    for (std::size_t i = 0; i + few < n; ++i) {
      of_file.push_back(distance(poses.estimate, i, i + few));
      of_other.push_back(distance(poses.reference, i, i + few));
    }
    const double usual = median_value(std::move(of_other));
    if (usual > 0.0) scale = median_value(std::move(of_file)) / usual;
    for (std::size_t i = 0; i + 1 < n; ++i) differences.push_back(std::abs(excess(i, i + 1)));
    std::ranges::sort(differences);
    largest = std::max(kOverUsual * percentile(differences, kMost),
                       kOfSpread * scale * spread_of(n, [&](std::size_t i) -> const Vector3& {
                         return poses.reference[i].world_from_body.translation;
                       }));
  }

  double expected(std::size_t i, std::size_t j) const {
    return scale * distance(poses.reference, i, j);
  }
  double excess(std::size_t i, std::size_t j) const {
    return distance(poses.estimate, i, j) - expected(i, j);
  }
  bool is_jump(std::size_t i, std::size_t j) const {
    constexpr double kOverExpected = 3.0;
    return excess(i, j) > std::max(largest, kOverExpected * expected(i, j));
  }
};

/// Root mean square of the distances after a similarity [m].
double position_error(const Paired& poses) {
  const Eigen::Affine3d aligned = similarity(poses);
  double squares = 0.0;
  for (std::size_t i = 0; i < poses.estimate.size(); ++i) {
    squares += (poses.reference[i].world_from_body.translation -
                aligned * poses.estimate[i].world_from_body.translation)
                   .squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(poses.estimate.size()));
}

/// Accepts a change of a file that reduces the error of its positions.
std::optional<std::string> accept(Trajectory& file,
                                  Trajectory changed,
                                  const Trajectory& other,
                                  double most_ratio) {
  const Paired before = Steps(file, other).poses, after = Steps(changed, other).poses;
  if (after.estimate.size() < kFewestCommonPoses) return std::nullopt;
  const double was = position_error(before), is = position_error(after);
  if (!(is < most_ratio * was)) return std::nullopt;
  file = std::move(changed);
  return fmt::format("position error after alignment with scale {:.3g} -> {:.3g} m", was, is);
}

}  // namespace

std::optional<InputFinding> remove_standstill(Trajectory& file,
                                              const Trajectory& other,
                                              const std::string& name) {
  constexpr double kSame = 1e-9, kOverLargest = 2.0, kMostRatio = 0.9;
  const Steps steps(file, other);
  const Trajectory& poses = steps.poses.estimate;
  if (poses.size() < kFewestCommonPoses) return std::nullopt;
  std::vector<double> lost;  // stamps
  double moved = 0.0;
  for (std::size_t begin = 0, end = 0; begin + 1 < poses.size(); begin = end + 1) {
    end = begin;
    while (end + 1 < poses.size() && distance(poses, begin, end + 1) < kSame) ++end;
    const bool is_jump = begin > 0 && steps.is_jump(begin - 1, begin);
    if (is_jump || steps.expected(begin, end) < kOverLargest * steps.largest) continue;
    moved = std::max(moved, distance(steps.poses.reference, begin, end));
    for (std::size_t i = begin + 1; i <= end; ++i) lost.push_back(poses[i].stamp);
  }
  if (lost.empty()) return std::nullopt;
  Trajectory moving = file;
  std::erase_if(moving, [&](const StampedPose& pose) {
    return std::ranges::binary_search(lost, pose.stamp);
  });
  const auto change = accept(file, std::move(moving), other, kMostRatio);
  if (!change) return std::nullopt;
  return InputFinding{
      Fault::missing_poses,
      fmt::format(
          "{} poses of the {} repeat the one before, the first at {:.3f} s, while the other "
          "file moves by up to {:.3g} m; without them, {}",
          lost.size(),
          name,
          lost.front(),
          moved,
          *change),
      "remove the rows in which tracking was lost, and state the coverage",
      1.0,
      static_cast<double>(lost.size())};
}

std::optional<InputFinding> remove_jumps(Trajectory& file,
                                         const Trajectory& other,
                                         const std::string& name) {
  constexpr std::size_t kListed = 5, kReturnsWithin = 20;  // jumps
  constexpr std::size_t kLongest = 20;                     // outlier, as a part of the poses
  constexpr double kLongestPause = 100.0;
  constexpr double kMostRatio = 0.95, kLeastAngle = 0.3;  // [-], [rad]
  const Steps steps(file, other);
  const Trajectory& poses = steps.poses.estimate;
  const double longest = kLongestPause * longest_gap(poses);  // [s]; after a stray stamp
  std::vector<std::size_t> jumps;                             // begins of steps
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    const bool is_other_time = poses[i + 1].stamp - poses[i].stamp > longest;
    if (!is_other_time && steps.is_jump(i, i + 1)) jumps.push_back(i);
  }
  if (jumps.empty() || jumps.size() > poses.size() / 6) return std::nullopt;
  /// Whether a jump after pose j undoes the one after pose i.
  const auto is_return = [&](std::size_t i, std::size_t j) {
    const double ratio = distance(poses, j, j + 1) / distance(poses, i, i + 1);
    return j - i <= poses.size() / kLongest && ratio > 0.5 && ratio < 2.0 &&
           !steps.is_jump(i, j + 1);
  };
  std::string list;
  Trajectory changed;
  Pose back;  // of all poses since the last jump that no other one undoes
  std::size_t copied = 0, count = 0;
  const auto copy_until = [&](std::size_t end) {
    for (; copied < end; ++copied) {
      changed.push_back({poses[copied].stamp, back * poses[copied].world_from_body});
    }
  };
  for (std::size_t k = 0; k < jumps.size(); ++k) {
    const std::size_t i = jumps[k];
    if (++count <= kListed) {
      list += fmt::format("{}{:.3f} s ({:.3g} m, the other file moves by {:.3g} m)",
                          list.empty() ? "" : ", ",
                          poses[i + 1].stamp,
                          distance(poses, i, i + 1),
                          distance(steps.poses.reference, i, i + 1));
    }
    copy_until(i + 1);
    const std::size_t last = std::min(jumps.size(), k + kReturnsWithin);
    std::size_t end = k + 1;
    while (end < last && !is_return(i, jumps[end])) ++end;
    if (end < last) {  // an outlier
      k = end;
      copied = jumps[end] + 1;
      continue;
    }
    const Pose& from = changed.back().world_from_body;
    const Pose to = back * poses[i + 1].world_from_body;
    const auto angle = [&](const Trajectory& all) {
      return angle_between(all[i].world_from_body.rotation, all[i + 1].world_from_body.rotation);
    };
    const bool has_other_axes =  // as a new map
        std::abs(angle(poses) - angle(steps.poses.reference)) > kLeastAngle;
    const Rotation turn =
        has_other_axes ? from.rotation * to.rotation.conjugate() : Rotation::Identity();
    back = normalized(Pose{turn, from.translation - turn * to.translation} * back);
  }
  copy_until(poses.size());
  const auto change = accept(file, std::move(changed), other, kMostRatio);
  if (!change) return std::nullopt;
  if (count > kListed) {
    const std::size_t more = count - kListed;
    list += fmt::format(" and {} more time{}", more, more == 1 ? "" : "s");
  }
  return InputFinding{
      Fault::jumps,
      fmt::format("the {}'s position jumps at {}: without them, {}", name, list, *change),
      "evaluate the parts on their own (traj crop), or repair the source",
      1.0,
      static_cast<double>(count)};
}

std::optional<InputFinding> repair_order(Trajectory& file,
                                         const Trajectory& other,
                                         const std::string& name) {
  constexpr double kMostRatio = 0.3;
  for (const std::size_t first : {std::size_t{0}, std::size_t{1}}) {
    std::vector<std::size_t> order(file.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::to_string(i + first); });
    Trajectory changed = file;
    for (std::size_t i = 0; i < order.size(); ++i) {
      changed[order[i]].world_from_body = file[i].world_from_body;
    }
    if (const auto change = accept(file, std::move(changed), other, kMostRatio)) {
      return InputFinding{
          Fault::jumps,
          fmt::format(
              "the rows of the {} are in alphabetical order: in the right one, {}", name, *change),
          "sort by numbers (sort -V): 2 before 10",
          1.0,
          static_cast<double>(file.size())};
    }
  }
  return std::nullopt;
}

}  // namespace loopbench::metrics
