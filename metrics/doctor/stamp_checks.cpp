#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <utility>

#include "metrics/doctor/pair_checks.hpp"

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

std::optional<InputFinding> check_stamp_unit(const Trajectory& reference,
                                             const Trajectory& estimate) {
  constexpr double kHardly = 0.01, kMostly = 0.5;  // of a duration
  if (reference.size() < 2 || estimate.size() < 2) return std::nullopt;
  const double longest = std::max(duration(reference), duration(estimate));
  if (overlap(reference, estimate) > kHardly * longest) return std::nullopt;
  for (const auto& [factor, unit] : {std::pair{1e-3, "milliseconds"},
                                     std::pair{1e-6, "microseconds"},
                                     std::pair{1e-9, "nanoseconds"}}) {
    for (const bool is_reference : {false, true}) {
      const Trajectory& wrong = is_reference ? reference : estimate;
      const Trajectory& other = is_reference ? estimate : reference;
      const Trajectory ends{{factor * wrong.front().stamp, {}}, {factor * wrong.back().stamp, {}}};
      const auto [shorter, longer] = std::minmax({duration(ends), duration(other)});
      const double common = overlap(ends, other);
      if (shorter < kHardly * longer || common < kMostly * shorter) continue;
      return InputFinding{
          Fault::stamp_unit,
          fmt::format("the stamps of the {} are {}: with seconds, {:.1f} s are common",
                      is_reference ? "reference" : "estimate",
                      unit,
                      common),
          fmt::format("traj transform {} --stamp-scale {:g}", is_reference ? "REF" : "EST", factor),
          1.0,
          is_reference ? factor : 1.0 / factor};
    }
  }
  return std::nullopt;
}

std::optional<InputFinding> check_overlap(const Trajectory& reference,
                                          const Trajectory& estimate,
                                          double offset) {
  if (reference.empty() || estimate.empty()) return std::nullopt;
  const double first = estimate.front().stamp + offset, last = estimate.back().stamp + offset;
  const double distance = std::max(first - reference.back().stamp, reference.front().stamp - last);
  if (!(distance > 0.0)) return std::nullopt;
  const bool has_indices = has_frame_indices(estimate) && !has_frame_indices(reference);
  return InputFinding{Fault::no_overlap,
                      fmt::format("the estimate's stamps ({:.3f} to {:.3f}) and the reference's "
                                  "({:.3f} to {:.3f}) have no common time{}",
                                  first,
                                  last,
                                  reference.front().stamp,
                                  reference.back().stamp,
                                  has_indices ? "; the estimate's are frame numbers" : ""),
                      has_indices ? "write the estimate's stamps in seconds"
                                  : "give files of the same recording, or the offset (--offset)",
                      1.0,
                      distance};
}

std::optional<InputFinding> check_missing(const Trajectory& reference,
                                          const Trajectory& estimate,
                                          double offset) {
  constexpr double kLeastShare = 0.25, kLeastLost = 0.12, kLeastGap = 2.0;  // of the path; [s]
  if (std::min(reference.size(), estimate.size()) < kFewestCommonPoses) return std::nullopt;
  const double least = std::max(kLeastGap, kUsualGaps * usual_interval(estimate));
  double all = 0.0, missing = 0.0, lost = 0.0, longest = 0.0, begin = 0.0;  // lost: between poses
  const std::size_t step = even_step(reference.size(), kMostPoses);
  const double pause = std::max(least, 3.0 * static_cast<double>(step) * usual_interval(reference));
  for (std::size_t i = step; i < reference.size(); i += step) {
    if (reference[i].stamp - reference[i - step].stamp > pause) continue;  // in both files
    const Pose& from = reference[i - step].world_from_body;
    const double length = (reference[i].world_from_body.translation - from.translation).norm();
    all += length;
    const double stamp = 0.5 * (reference[i - step].stamp + reference[i].stamp) - offset;
    const auto next = std::ranges::lower_bound(estimate, stamp, {}, &StampedPose::stamp);
    const bool is_after = next == estimate.end(), is_before = next == estimate.begin();
    const double low = is_before ? reference.front().stamp - offset : std::prev(next)->stamp;
    const double high = is_after ? reference.back().stamp - offset : next->stamp;
    if (high - low <= least) continue;
    missing += length;
    if (!is_after && !is_before) lost += length;
    if (high - low > longest) {
      longest = high - low;
      begin = low;
    }
  }
  const double share = all > 0.0 ? missing / all : 0.0;
  if (share < kLeastShare && lost <= kLeastLost * all) return std::nullopt;
  return InputFinding{
      Fault::missing_poses,
      fmt::format("the estimate has no poses for {:.0f} % of the reference's path; the longest "
                  "gap has {:.1f} s and begins at {:.3f}",
                  100.0 * share,
                  longest,
                  begin),
      "errors hold for the covered part only: state the coverage, or run the system again",
      1.0,
      share};
}

}  // namespace loopbench::metrics
