#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "metrics/doctor/pair_checks.hpp"
#include "metrics/numerics/average.hpp"

namespace loopbench::metrics {
namespace {

double distance(const Trajectory& poses, std::size_t i, std::size_t j) {
  return (poses[j].world_from_body.translation - poses[i].world_from_body.translation).norm();
}

/// Simultaneous poses of a file and of the other one, and what steps of the file are.
struct Steps {
  const Trajectory& file;
  const Trajectory& other;
  double scale = 1.0;    ///< of the file, over the other one
  double largest = 0.0;  ///< longer steps than the other file's by this are jumps [m]

  Steps(const Trajectory& from, const Trajectory& to) : file(from), other(to) {
    // Over what 85 % of the steps are longer by; of all positions' spread.
    constexpr double kOverUsual = 20.0, kMost = 0.85, kOfSpread = 0.02;
    const std::size_t n = file.size(), few = n / 200 + 1;
    std::vector<double> of_file, of_other, differences;
    for (std::size_t i = 0; i + few < n; ++i) {
      of_file.push_back(distance(file, i, i + few));
      of_other.push_back(distance(other, i, i + few));
    }
    const double usual = median_value(std::move(of_other));
    if (usual > 0.0) scale = median_value(std::move(of_file)) / usual;
    for (std::size_t i = 0; i + 1 < n; ++i) differences.push_back(std::abs(excess(i, i + 1)));
    std::ranges::sort(differences);
    largest = std::max(kOverUsual * percentile(differences, kMost),
                       kOfSpread * scale * spread_of(n, [&](std::size_t i) -> const Vector3& {
                         return other[i].world_from_body.translation;
                       }));
  }

  double expected(std::size_t i, std::size_t j) const { return scale * distance(other, i, j); }
  double excess(std::size_t i, std::size_t j) const {
    return distance(file, i, j) - expected(i, j);
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

}  // namespace

std::optional<InputFinding> remove_jumps(Paired& pairs, bool of_reference) {
  constexpr std::size_t kReturnsWithin = 20;              // jumps, or this part of the poses
  constexpr std::size_t kMostJumps = 6;                   // the same; more are noise
  constexpr double kLongestPause = 100.0;                 // over the usual; after a stray stamp
  constexpr double kMostRatio = 0.95, kLeastAngle = 0.3;  // [-], [rad]
  const Trajectory& poses = of_reference ? pairs.reference : pairs.estimate;
  const Trajectory& other = of_reference ? pairs.estimate : pairs.reference;
  if (poses.size() < kFewestCommonPoses) return std::nullopt;
  const Steps steps(poses, other);
  const double longest = kLongestPause * longest_gap(poses);  // [s]
  std::vector<std::size_t> jumps;                             // begins of steps
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    const bool is_other_time = poses[i + 1].stamp - poses[i].stamp > longest;
    if (!is_other_time && steps.is_jump(i, i + 1)) jumps.push_back(i);
  }
  if (jumps.empty() || jumps.size() > poses.size() / kMostJumps) return std::nullopt;
  /// Whether a jump after pose j undoes the one after pose i.
  const auto is_return = [&](std::size_t i, std::size_t j) {
    const double ratio = distance(poses, j, j + 1) / distance(poses, i, i + 1);
    return j - i <= poses.size() / kReturnsWithin && ratio > 0.5 && ratio < 2.0 &&
           !steps.is_jump(i, j + 1);
  };
  std::string list;
  Paired changed;
  Pose back;  // of all poses since the last jump that no other one undoes
  std::size_t copied = 0, count = 0;
  const auto copy_until = [&](std::size_t end) {
    for (; copied < end; ++copied) {
      Trajectory& moved = of_reference ? changed.reference : changed.estimate;
      moved.push_back({poses[copied].stamp, back * poses[copied].world_from_body});
      (of_reference ? changed.estimate : changed.reference).push_back(other[copied]);
    }
  };
  for (std::size_t k = 0; k < jumps.size(); ++k) {
    const std::size_t i = jumps[k];
    if (++count <= kListed) {
      list += fmt::format("{}{:.3f} s ({:.3g} m, the other file moves by {:.3g} m)",
                          list.empty() ? "" : ", ",
                          poses[i + 1].stamp,
                          distance(poses, i, i + 1),
                          distance(other, i, i + 1));
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
    const Trajectory& before = of_reference ? changed.reference : changed.estimate;
    const Pose& from = before.back().world_from_body;
    const Pose to = back * poses[i + 1].world_from_body;
    const auto angle = [&](const Trajectory& all) {
      return angle_between(all[i].world_from_body.rotation, all[i + 1].world_from_body.rotation);
    };
    const bool has_other_axes =  // as a new map
        std::abs(angle(poses) - angle(other)) > kLeastAngle;
    const Rotation turn =
        has_other_axes ? from.rotation * to.rotation.conjugate() : Rotation::Identity();
    back = normalized(Pose{turn, from.translation - turn * to.translation} * back);
  }
  copy_until(poses.size());
  if (changed.estimate.size() < kFewestCommonPoses) return std::nullopt;
  const double was = position_error(pairs), is = position_error(changed);
  if (!(is < kMostRatio * was)) return std::nullopt;
  pairs = std::move(changed);
  if (count > kListed) {
    const std::size_t more = count - kListed;
    list += fmt::format(" and {} more time{}", more, more == 1 ? "" : "s");
  }
  return InputFinding{
      Fault::jumps,
      fmt::format("the {}'s position jumps at {}: without them, position error after alignment "
                  "with scale {:.3g} -> {:.3g} m",
                  of_reference ? "reference" : "estimate",
                  list,
                  was,
                  is),
      "evaluate the parts on their own (traj crop), or repair the source",
      1.0,
      static_cast<double>(count)};
}

}  // namespace loopbench::metrics
