#include "metrics/doctor/file_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "metrics/doctor/common_motion.hpp"
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

double rate(const Trajectory& poses) {
  const double duration = poses.back().stamp - poses.front().stamp;
  return duration > 0.0 ? static_cast<double>(poses.size() - 1) / duration : 0.0;
}

/// Largest angle to the first rotation [rad].
double largest_rotation(const Trajectory& poses) {
  double out = 0.0;
  for (const StampedPose& pose : poses) {
    out = std::max(
        out, angle_between(poses.front().world_from_body.rotation, pose.world_from_body.rotation));
  }
  return out;
}

/// Largest distance to the first position [m].
double largest_distance(const Trajectory& poses) {
  double out = 0.0;
  for (const StampedPose& pose : poses) {
    out = std::max(
        out, (pose.world_from_body.translation - poses.front().world_from_body.translation).norm());
  }
  return out;
}

constexpr double kConstant = 1e-6;  // [rad]

/// Median ratio of rotation angles over short intervals, without wraps.
double angle_ratio(const CommonPoses& poses) {
  constexpr double kLeast = 0.05 / kDegrees, kMost = 2.5 / kDegrees;
  std::vector<double> ratios;
  for (std::size_t i = 1; i < poses.stamps.size(); ++i) {
    const auto angle = [&](const std::vector<Pose>& list) {
      return angle_between(list[i - 1].rotation, list[i].rotation);
    };
    const double reference = angle(poses.reference);
    const double estimate = angle(poses.estimate);
    const double smaller = std::min(reference, estimate);
    if (smaller < kLeast || smaller > kMost) continue;
    ratios.push_back(estimate / reference);
  }
  return ratios.size() < 8 ? 1.0 : median_value(std::move(ratios));
}

/// Median ratio of rotation angles over intervals in which the reference rotates by 5 to 60 deg.
double ratio_of_larger_angles(const CommonPoses& poses) {
  constexpr double kLeast = 5.0 / kDegrees, kMost = 60.0 / kDegrees;
  std::vector<double> ratios;
  std::size_t from = 0;
  for (std::size_t to = 1; to < poses.stamps.size(); ++to) {
    const auto angle = [&](const std::vector<Pose>& list) {
      return angle_between(list[from].rotation, list[to].rotation);
    };
    const double reference = angle(poses.reference);
    if (reference < kLeast) continue;
    if (reference <= kMost) ratios.push_back(angle(poses.estimate) / reference);
    from = to;
  }
  return ratios.size() < 8 ? 1.0 : median_value(std::move(ratios));
}

/// Steps of the estimate far above those of the reference and its own.
std::vector<std::size_t> jumps_of(const CommonPoses& poses) {
  constexpr double kOverReference = 5.0, kOverUsual = 10.0, kOfSpread = 0.02;
  constexpr std::size_t kMost = 5;
  const std::size_t n = poses.stamps.size();
  const auto steps = [&](const std::vector<Pose>& list) {
    std::vector<double> out;
    for (std::size_t i = 1; i < n; ++i) {
      out.push_back((list[i].translation - list[i - 1].translation).norm());
    }
    return out;
  };
  const std::vector<double> reference = steps(poses.reference), estimate = steps(poses.estimate);
  const double usual = median_value(estimate), of_reference = median_value(reference);
  const double scale = of_reference > 0.0 ? usual / of_reference : 1.0;
  const double spread = scale * agreement(poses).spread;
  std::vector<std::size_t> out;
  for (std::size_t i = 1; i < n; ++i) {
    const double least = std::max(
        {kOverReference * scale * reference[i - 1], kOverUsual * usual, kOfSpread * spread});
    if (estimate[i - 1] > least) out.push_back(i);
  }
  return out.size() > kMost ? std::vector<std::size_t>{} : out;
}

}  // namespace

std::optional<InputFinding> check_swapped(const Trajectory& reference,
                                          const Trajectory& estimate,
                                          const std::string& reference_name,
                                          const std::string& estimate_name) {
  constexpr double kRates = 2.0;
  if (reference.size() < 2 || estimate.size() < 2) return std::nullopt;
  const bool reference_is_named = names_truth(reference_name);
  const bool estimate_is_named = names_truth(estimate_name);
  if (reference_is_named) return std::nullopt;
  const double rates = rate(estimate) / rate(reference);
  const bool covers = estimate.front().stamp <= reference.front().stamp &&
                      estimate.back().stamp >= reference.back().stamp;
  const bool rotate =
      largest_rotation(reference) > kConstant && largest_rotation(estimate) > kConstant;
  const bool is_denser = rates >= kRates && covers && rotate;
  if (!estimate_is_named && !is_denser) return std::nullopt;
  return InputFinding{
      Fault::swapped,
      fmt::format("the estimate {}",
                  estimate_is_named ? "is named like a reference: " + estimate_name
                                    : fmt::format("has {:.1f} times the rate of the reference and "
                                                  "covers it in time",
                                                  rates)),
      "exchange REF and EST",
      estimate_is_named && is_denser ? 0.98
      : estimate_is_named            ? 0.9
                                     : 0.7,
      rates};
}

std::optional<InputFinding> check_constant_rotation(const Trajectory& reference,
                                                    const Trajectory& estimate) {
  constexpr double kMoves = 0.5;         // [m]
  constexpr double kOtherRotates = 0.3;  // [rad]
  constexpr std::size_t kFewestPoses = 10;
  if (reference.size() < kFewestPoses || estimate.size() < kFewestPoses) return std::nullopt;
  const double of_reference = largest_rotation(reference);
  const double of_estimate = largest_rotation(estimate);
  if (std::min(of_reference, of_estimate) > kConstant) return std::nullopt;
  const bool is_reference = of_reference < of_estimate;
  const double distance = largest_distance(is_reference ? reference : estimate);
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
  const double of_larger = ratio_of_larger_angles(poses);
  const double ratio = of_larger < 0.1 ? of_larger : angle_ratio(poses);
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
  constexpr double kBetter = 0.5;
  const std::vector<std::size_t> jumps = jumps_of(poses);
  if (poses.stamps.size() < kFewestCommonPoses || jumps.empty()) return std::nullopt;
  CommonPoses without = poses;
  std::string stamps;
  for (const std::size_t at : jumps) {
    const Vector3 jump = without.estimate[at].translation - without.estimate[at - 1].translation;
    for (std::size_t i = at; i < without.estimate.size(); ++i) {
      without.estimate[i].translation -= jump;
    }
    stamps += fmt::format("{}{:.3f}", stamps.empty() ? "" : ", ", poses.stamps[at]);
  }
  const Agreement before = agreement(poses), after = agreement(without);
  const double ratio = after.similarity / before.similarity;
  if (!(ratio < kBetter)) return std::nullopt;
  poses = std::move(without);
  return InputFinding{
      Fault::jumps,
      fmt::format("the estimate's position jumps at {} s: without, position error after alignment "
                  "with scale {:.3g} -> {:.3g} m",
                  stamps,
                  before.similarity,
                  after.similarity),
      "evaluate the parts on their own (traj crop), or repair the source",
      1.0 - ratio,
      static_cast<double>(jumps.size())};
}

}  // namespace loopbench::metrics
