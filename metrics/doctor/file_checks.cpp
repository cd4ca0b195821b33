#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <utility>

#include "metrics/doctor/pair_checks.hpp"
#include "metrics/numerics/angle.hpp"

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
  constexpr double kTolerance = 2.2, kLeastPart = 0.3, kMostLeft = 0.3;
  constexpr std::size_t kFewest = 8;
  std::vector<std::pair<double, double>> angles;  // of the reference, of the estimate [rad]
  std::size_t from = 0, large = 0;
  for (std::size_t to = 1; to < poses.estimate.size(); ++to) {
    const auto angle = [&](const Trajectory& list) {
      return angle_between(list[from].world_from_body.rotation, list[to].world_from_body.rotation);
    };
    const std::pair both{angle(poses.reference), angle(poses.estimate)};
    const auto [smaller, larger] = std::minmax(both.first, both.second);
    if (larger < kLeast) continue;
    ++large;
    if (larger <= kMost && smaller > 0.0 && smaller < kMostOfOther) angles.push_back(both);
    from = to;
  }
  const double part = static_cast<double>(angles.size()) / static_cast<double>(large);
  if (angles.size() < kFewest || part < kLeastPart) return std::nullopt;
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
  if (after > kMostLeft * before) return std::nullopt;
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

}  // namespace loopbench::metrics
