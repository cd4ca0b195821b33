#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "metrics/doctor/agreement.hpp"
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
  double longest = 0.0;  ///< pause; longer ones follow a stray stamp [s]
  double largest = 0.0;  ///< longer steps than the other file's by this are jumps [m]

  Steps(const Trajectory& from, const Trajectory& to) : file(from), other(to) {
    // Over what 85 % of the steps are longer by; of all positions' spread.
    constexpr double kOverUsual = 20.0, kMost = 0.85, kOfSpread = 0.02, kLongestPause = 100.0;
    longest = kLongestPause * longest_gap(file);
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

  double excess(std::size_t i, std::size_t j) const {
    return distance(file, i, j) - scale * distance(other, i, j);
  }
  bool is_jump(std::size_t i, std::size_t j) const {
    constexpr double kOverExpected = 3.0;
    if (file[j].stamp - file[i].stamp > longest) return false;
    return excess(i, j) > std::max(largest, kOverExpected * scale * distance(other, i, j));
  }
};

}  // namespace

std::optional<InputFinding> remove_jumps(Paired& pairs, bool of_reference) {
  constexpr std::size_t kOutliers = 20;  // at most this part of the poses; more jumps are noise
  Trajectory Paired::*const file = of_reference ? &Paired::reference : &Paired::estimate;
  const Trajectory& poses = pairs.*file;
  const Trajectory& other = of_reference ? pairs.estimate : pairs.reference;
  const std::size_t n = poses.size();
  if (n < kFewestCommonPoses) return std::nullopt;
  const Steps steps(poses, other);
  std::vector<std::string> list;
  std::size_t count = 0;
  Paired changed;
  Vector3 back = Vector3::Zero();  // undoes the jumps that no other one undoes
  for (std::size_t last = 0, i = 0; i < n; ++i) {
    // Only another jump ends an outlier; motion alone can lead back, too.
    const bool is_outlier = i > last + 1;
    if (steps.is_jump(last, i) || (is_outlier && !steps.is_jump(i - 1, i))) {
      if (i == last + 1 && ++count <= kListed) {
        list.push_back(fmt::format("{:.3f} s ({:.3g} m, the other file moves by {:.3g} m)",
                                   poses[i].stamp,
                                   distance(poses, last, i),
                                   distance(other, last, i)));
      }
      if (i - last <= n / kOutliers && i + 1 < n) continue;  // an outlier, so far
      i = last + 1;  // the positions stay where they have jumped to
      back =
          (changed.*file).back().world_from_body.translation - poses[i].world_from_body.translation;
    }
    last = i;
    changed.reference.push_back(pairs.reference[i]);
    changed.estimate.push_back(pairs.estimate[i]);
    (changed.*file).back().world_from_body.translation += back;
  }
  if (count == 0 || count > n / kOutliers) return std::nullopt;
  const double was = position_error(pairs, similarity(pairs)),
               is = position_error(changed, similarity(changed));
  if (!(is < kMostRatio * was)) return std::nullopt;
  pairs = std::move(changed);
  std::string all = fmt::format("{}", fmt::join(list, ", "));
  if (count > kListed)
    all += fmt::format(" and {} more time{}", count - kListed, count == kListed + 1 ? "" : "s");
  return InputFinding{
      Fault::jumps,
      fmt::format("the {}'s position jumps at {}: without them, position error after alignment "
                  "with scale {:.3g} -> {:.3g} m",
                  of_reference ? "reference" : "estimate",
                  all,
                  was,
                  is),
      "evaluate each part separately (traj crop), or repair the source",
      1.0,
      static_cast<double>(count)};
}

}  // namespace loopbench::metrics
