#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <utility>

#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/pair_checks.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

/// Lower-case words of the last two parts of a path, separated by '_', '-', '.' and '/'.
bool names_truth(const std::string& name) {
  const std::filesystem::path path(name);
  const std::string tail = (path.parent_path().filename() / path.filename()).string() + "/";
  std::string word;
  for (const char c : tail) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalpha(letter) != 0) {
      word += static_cast<char>(std::tolower(letter));
      continue;
    }
    for (const char* const known :
         {"groundtruth", "truth", "gt", "reference", "vicon", "leica", "mocap"}) {
      if (word == known) return true;
    }
    word.clear();
  }
  return false;
}

/// Largest distance [m] and rotation angle [rad] from the first pose.
std::pair<double, double> largest_motion(const Trajectory& poses) {
  std::pair<double, double> out;
  for (const StampedPose& pose : poses) {
    const Pose moved = poses.front().world_from_body.inverse() * pose.world_from_body;
    out.first = std::max(out.first, moved.translation.norm());
    out.second = std::max(out.second, angle_between(moved.rotation, Rotation::Identity()));
  }
  return out;
}

constexpr double kConstant = 1e-6;  // [rad]

/// Median ratio of rotation angles over intervals in which the trajectory that rotates more does so
/// by 20 to 120 deg, and the other one by less than 2.5 deg: larger angles times 57 are ambiguous.
double angle_ratio(const CommonPoses& poses) {
  constexpr double kLeast = 20.0 / kDegrees, kMost = 120.0 / kDegrees,
                   kMostOfOther = 2.5 / kDegrees;
  std::vector<double> ratios;
  std::size_t from = 0;
  for (std::size_t to = 1; to < poses.stamps.size(); ++to) {
    const auto angle = [&](const std::vector<Pose>& list) {
      return angle_between(list[from].rotation, list[to].rotation);
    };
    const double reference = angle(poses.reference), estimate = angle(poses.estimate);
    const double larger = std::max(reference, estimate);
    if (larger < kLeast) continue;
    const double smaller = std::min(reference, estimate);
    if (larger <= kMost && smaller > 0.0 && smaller < kMostOfOther) {
      ratios.push_back(estimate / reference);
    }
    from = to;
  }
  return ratios.size() < 8 ? 1.0 : median_value(std::move(ratios));
}

/// A step of the estimate far above that of the reference.
struct Jump {
  std::size_t at = 0;
  double metres = 0.0, of_reference = 0.0;
};

std::vector<Jump> jumps_of(const CommonPoses& poses) {
  constexpr double kOverUsual = 8.0, kOverReference = 2.0, kOfSpread = 0.01, kNearlyAll = 0.95;
  constexpr std::size_t kMost = 5;
  const auto step = [](const std::vector<Pose>& list, std::size_t i) {
    return (list[i].translation - list[i - 1].translation).norm();
  };
  const std::size_t n = poses.stamps.size();
  std::vector<double> of_reference, of_estimate, excess;
  for (std::size_t i = 1; i < n; ++i) {
    of_reference.push_back(step(poses.reference, i));
    of_estimate.push_back(step(poses.estimate, i));
  }
  const double usual = median_value(of_reference);
  const double scale = usual > 0.0 ? median_value(of_estimate) / usual : 1.0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    excess.push_back(of_estimate[i] - scale * of_reference[i]);
  }
  std::vector<double> sorted = excess;
  for (double& each : sorted) each = std::abs(each);
  std::ranges::sort(sorted);
  const double nearly_all =
      sorted[static_cast<std::size_t>(kNearlyAll * static_cast<double>(n - 2))];
  const double least =
      std::max(kOverUsual * nearly_all, kOfSpread * scale * agreement(poses).spread);
  std::vector<Jump> out;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    if (excess[i] < std::max(least, kOverReference * scale * of_reference[i])) continue;
    out.push_back({i + 1, of_estimate[i], of_reference[i]});
  }
  return out.size() > kMost ? std::vector<Jump>{} : out;
}

}  // namespace

std::optional<InputFinding> check_swapped(const std::string& reference_name,
                                          const std::string& estimate_name) {
  if (names_truth(reference_name) || !names_truth(estimate_name)) return std::nullopt;
  return InputFinding{Fault::swapped,
                      "the estimate is named like a reference: " + estimate_name,
                      "exchange REF and EST",
                      0.9};
}

std::optional<InputFinding> check_constant_rotation(const Trajectory& reference,
                                                    const Trajectory& estimate) {
  constexpr double kMoves = 0.2;         // [m]
  constexpr double kOtherRotates = 0.1;  // [rad]
  constexpr std::size_t kFewestPoses = 10;
  if (reference.size() < kFewestPoses || estimate.size() < kFewestPoses) return std::nullopt;
  const auto [reference_moves, of_reference] = largest_motion(reference);
  const auto [estimate_moves, of_estimate] = largest_motion(estimate);
  if (std::min(of_reference, of_estimate) > kConstant) return std::nullopt;
  const bool is_reference = of_reference < of_estimate;
  const double distance = is_reference ? reference_moves : estimate_moves;
  const double rotation = std::max(of_reference, of_estimate);
  if (distance < kMoves || rotation < kOtherRotates) return std::nullopt;
  return InputFinding{
      Fault::constant_rotation,
      fmt::format("the {}'s rotation is constant while it moves by {:.3g} m and the {} rotates by "
                  "{:.0f} deg",
                  is_reference ? "reference" : "estimate",
                  distance,
                  is_reference ? "estimate" : "reference",
                  kDegrees * rotation),
      "write the file with rotations, or use position errors only (eval -r trans_part)",
      1.0,
      rotation};
}

std::optional<InputFinding> check_angle_unit(const CommonPoses& poses) {
  const double ratio = angle_ratio(poses);
  constexpr double kFactor = kDegrees, kTolerance = 2.2;
  const bool is_large = ratio > kFactor / kTolerance && ratio < kFactor * kTolerance;
  const bool is_small = ratio < kTolerance / kFactor && ratio > 1.0 / (kFactor * kTolerance);
  if (!is_large && !is_small) return std::nullopt;
  return InputFinding{
      Fault::angle_unit,
      fmt::format("the estimate rotates {:.3g} times as much as the reference", ratio),
      fmt::format(
          "{} were used as {} in the estimate, or the reverse in the reference: convert that "
          "file's source again, or use position errors only (eval -r trans_part)",
          is_large ? "degrees" : "radians",
          is_large ? "radians" : "degrees"),
      0.9,
      ratio};
}

std::optional<InputFinding> remove_jumps(CommonPoses& poses) {
  constexpr double kBetter = 0.97;
  if (poses.stamps.size() < kFewestCommonPoses) return std::nullopt;
  const std::vector<Jump> jumps = jumps_of(poses);
  if (jumps.empty()) return std::nullopt;
  CommonPoses without = poses;
  std::string list;
  for (const auto& [at, metres, of_reference] : jumps) {
    const Vector3 jump = without.estimate[at].translation - without.estimate[at - 1].translation;
    for (std::size_t i = at; i < without.estimate.size(); ++i) {
      without.estimate[i].translation -= jump;
    }
    list += fmt::format("{}{:.3f} s ({:.3g} m, the reference moves by {:.3g} m)",
                        list.empty() ? "" : ", ",
                        poses.stamps[at],
                        metres,
                        of_reference);
  }
  const Agreement before = agreement(poses), after = agreement(without);
  const double ratio = after.similarity / before.similarity;
  if (!(ratio < kBetter)) return std::nullopt;
  poses = std::move(without);
  return InputFinding{
      Fault::jumps,
      fmt::format("the estimate's position jumps at {}: without, position error after alignment "
                  "with scale {:.3g} -> {:.3g} m",
                  list,
                  before.similarity,
                  after.similarity),
      "evaluate the parts on their own (traj crop), or repair the source",
      std::max(0.6, 1.0 - ratio),
      static_cast<double>(jumps.size())};
}

}  // namespace loopbench::metrics
