#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <utility>

#include "metrics/doctor/pair_checks.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/numerics/percentile.hpp"

namespace loopbench::metrics {
namespace {

/// Whether a word of the last two parts of a path names a reference, not one that it is aligned to.
bool names_truth(const std::string& name) {
  static const std::regex known(
      "(^|[^a-z])(groundtruth|truth|gt|reference|vicon0|leica0|mocap)([^a-z]|$)",
      std::regex::icase);
  static const std::regex other("(^|[^a-z])(to|vs|with)[^a-z]", std::regex::icase);
  const std::filesystem::path path(name);
  const std::string parts = (path.parent_path().filename() / path.filename()).string();
  return std::regex_search(parts, known) && !std::regex_search(parts, other);
}

std::vector<double> steps_of(const Trajectory& poses) {
  std::vector<double> out;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Vector3& from = poses[i - 1].world_from_body.translation;
    out.push_back((poses[i].world_from_body.translation - from).norm());
  }
  return out;
}

}  // namespace

std::optional<InputFinding> check_swapped(const std::string& reference_name,
                                          const std::string& estimate_name) {
  if (names_truth(reference_name) || !names_truth(estimate_name)) return std::nullopt;
  return InputFinding{Fault::swapped,
                      "the estimate is named like a reference: " + estimate_name,
                      "exchange REF and EST if the name is right: nothing else was compared",
                      0.9};
}

std::optional<InputFinding> check_angle_unit(const Paired& poses) {
  constexpr double kLeast = 20.0 / kDegrees, kMost = 120.0 / kDegrees;  // of the larger angle
  constexpr double kMostOfOther = 2.5 / kDegrees;  // larger ones times 57 are ambiguous
  constexpr double kTolerance = 2.2;
  constexpr std::size_t kFewest = 8;
  std::vector<std::pair<double, double>> angles;  // of the reference, of the estimate [rad]
  std::size_t from = 0;
  for (std::size_t to = 1; to < poses.estimate.size(); ++to) {
    const auto angle = [&](const Trajectory& list) {
      return angle_between(list[from].world_from_body.rotation, list[to].world_from_body.rotation);
    };
    const std::pair both{angle(poses.reference), angle(poses.estimate)};
    const auto [smaller, larger] = std::minmax(both.first, both.second);
    if (larger < kLeast) continue;
    if (larger <= kMost && smaller > 0.0 && smaller < kMostOfOther) angles.push_back(both);
    from = to;
  }
  if (angles.size() < kFewest) return std::nullopt;
  const auto median_of = [&](auto measure) {
    std::vector<double> values;
    for (const auto& [reference, estimate] : angles) {
      values.push_back(measure(reference, estimate));
    }
    return median_value(std::move(values));
  };
  const double ratio = median_of([](double r, double e) { return e / r; });
  const bool is_large = ratio > 1.0;
  const double size = is_large ? ratio : 1.0 / ratio, factor = is_large ? 1.0 / kDegrees : kDegrees;
  if (size < kDegrees / kTolerance || size > kDegrees * kTolerance) return std::nullopt;
  const double before = median_of([](double r, double e) { return std::abs(e - r); });
  const double after = median_of([&](double r, double e) { return std::abs(factor * e - r); });
  return InputFinding{
      Fault::angle_unit,
      fmt::format("multiplying the estimate's angles by {:.3g}: rotation between poses {:.3g} -> "
                  "{:.3g} deg from the reference's",
                  factor,
                  kDegrees * before,
                  kDegrees * after),
      fmt::format(
          "{} were used as {} in the estimate, or the reverse in the reference: convert that "
          "file's source again, or use position errors only (eval -r trans_part)",
          is_large ? "degrees" : "radians",
          is_large ? "radians" : "degrees"),
      1.0 - after / before,
      ratio};
}

std::optional<InputFinding> remove_jumps(Paired& poses) {
  constexpr double kOverUsual = 12.0, kOverReference = 2.0, kOfSpread = 0.01, kMost = 0.9;
  constexpr std::size_t kListed = 5;
  constexpr double kBetter = 0.97, kLeastAngle = 0.3;  // [-], [rad]
  const Agreement before = agreement(poses);
  const std::vector<double> of_reference = steps_of(poses.reference);
  const std::vector<double> of_estimate = steps_of(poses.estimate);
  const double usual = median_value(of_reference);
  const double scale = usual > 0.0 ? median_value(of_estimate) / usual : 1.0;
  std::vector<double> sorted;
  for (std::size_t i = 0; i < of_reference.size(); ++i) {
    sorted.push_back(std::abs(of_estimate[i] - scale * of_reference[i]));
  }
  std::ranges::sort(sorted);
  const double least =
      std::max(kOverUsual * percentile(sorted, kMost), kOfSpread * scale * before.spread);
  const std::size_t most = of_reference.size() / 10;  // two of each outlier
  Paired without = poses;
  std::string list;
  std::size_t count = 0;
  for (std::size_t i = 0; i < of_reference.size(); ++i) {
    const double expected = scale * of_reference[i];
    if (of_estimate[i] - expected < std::max(least, kOverReference * expected)) continue;
    if (++count > most) return std::nullopt;
    const Pose& from = without.estimate[i].world_from_body;
    const Pose& to = without.estimate[i + 1].world_from_body;
    const auto angle = [&](const Trajectory& list) {
      return angle_between(list[i].world_from_body.rotation, list[i + 1].world_from_body.rotation);
    };
    const bool has_other_axes =  // as a new map
        std::abs(angle(poses.estimate) - angle(poses.reference)) > kLeastAngle;
    const Rotation turn =
        has_other_axes ? from.rotation * to.rotation.conjugate() : Rotation::Identity();
    const Pose back{turn, from.translation - turn * to.translation};
    for (std::size_t j = i + 1; j < without.estimate.size(); ++j) {
      without.estimate[j].world_from_body = back * without.estimate[j].world_from_body;
    }
    if (count > kListed) continue;
    list += fmt::format("{}{:.3f} s ({:.3g} m, the reference moves by {:.3g} m)",
                        list.empty() ? "" : ", ",
                        poses.estimate[i + 1].stamp,
                        of_estimate[i],
                        of_reference[i]);
  }
  if (count == 0) return std::nullopt;
  if (count > kListed) list += fmt::format(" and {} more times", count - kListed);
  const Agreement after = agreement(without);
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
      static_cast<double>(count)};
}

}  // namespace loopbench::metrics
