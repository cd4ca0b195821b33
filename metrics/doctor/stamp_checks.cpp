#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "metrics/doctor/graph_checks.hpp"
#include "metrics/doctor/pair_checks.hpp"
#include "metrics/doctor/sampling.hpp"

namespace loopbench::metrics {
namespace {

constexpr double kHardly = 0.01, kMostly = 0.5;  // of stamps, or of a duration

constexpr std::pair<double, std::string_view> kUnits[] = {
    {1e-3, "milliseconds"}, {1e-6, "microseconds"}, {1e-9, "nanoseconds"}};

bool is_small_letter(char c) { return c >= 'a' && c <= 'z'; }

/// Whether the text, in small letters, has the word without a letter before and after it.
bool has_word(std::string_view text, std::string_view word, bool can_be_last) {
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if (at > 0 && is_small_letter(text[at - 1])) continue;
    if (end < text.size() ? !is_small_letter(text[end]) : can_be_last) return true;
  }
  return false;
}

/// Whether a word of the last two parts of a path names a reference, not one that it is aligned to.
bool names_truth(const std::string& name) {
  constexpr std::string_view kKnown[] = {
      "groundtruth", "truth", "gt", "reference", "vicon0", "leica0", "mocap"};
  constexpr std::string_view kOther[] = {"to", "vs", "with"};
  const std::filesystem::path path(name);
  std::string parts = (path.parent_path().filename() / path.filename()).string();
  for (char& c : parts) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  const auto has = [&](bool can_be_last) {
    return
        [&parts, can_be_last](std::string_view word) { return has_word(parts, word, can_be_last); };
  };
  return std::ranges::any_of(kKnown, has(true)) && std::ranges::none_of(kOther, has(false));
}

/// Part of the stamps that are those of poses after multiplication by a factor.
double found_part(const std::vector<double>& loops, const Trajectory& poses, double factor) {
  const auto count = std::ranges::count_if(loops, [&](double stamp) {
    const std::size_t next = first_from(poses, factor * stamp - kLeastOffset);
    return next < poses.size() && poses[next].stamp <= factor * stamp + kLeastOffset;
  });
  return static_cast<double>(count) / static_cast<double>(loops.size());
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
  if (reference.size() < 2 || estimate.size() < 2) return std::nullopt;
  const double longest = std::max(duration(reference), duration(estimate));
  if (overlap(reference, estimate) > kHardly * longest) return std::nullopt;
  for (const auto& [factor, unit] : kUnits) {
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
                      distance,
                      has_indices};
}

std::optional<InputFinding> check_missing(const Trajectory& reference,
                                          const Trajectory& estimate,
                                          double offset) {
  constexpr double kLeastShare = 0.25, kLeastGap = 2.0;  // of the path; [s]
  if (std::min(reference.size(), estimate.size()) < kFewestCommonPoses) return std::nullopt;
  const double least = std::max(kLeastGap, kUsualGaps * usual_interval(estimate));
  double all = 0.0, missing = 0.0, longest = 0.0, begin = 0.0;
  const std::size_t step = even_step(reference.size(), kMostPoses);
  const double pause = std::max(least, 3.0 * static_cast<double>(step) * usual_interval(reference));
  for (std::size_t i = step; i < reference.size(); i += step) {
    const auto& [from, pose] = reference[i - step];
    if (reference[i].stamp - from > pause) continue;  // the reference has no poses, either
    const double length = (reference[i].world_from_body.translation - pose.translation).norm();
    all += length;
    const std::size_t next = first_from(estimate, 0.5 * (from + reference[i].stamp) - offset);
    const double low = (next == 0 ? reference.front().stamp - offset : estimate[next - 1].stamp);
    const double high =
        next == estimate.size() ? reference.back().stamp - offset : estimate[next].stamp;
    if (high - low <= least) continue;
    missing += length;
    if (high - low > longest) {
      longest = high - low;
      begin = low;
    }
  }
  if (!(missing > kLeastShare * all)) return std::nullopt;
  return InputFinding{
      Fault::missing_poses,
      fmt::format("the estimate has no poses for {:.0f} % of the reference's path; the longest "
                  "gap has {:.1f} s and begins at {:.3f}",
                  100.0 * missing / all,
                  longest,
                  begin),
      "errors hold for the covered part only: state the coverage, or run the system again",
      1.0,
      missing / all};
}

std::optional<InputFinding> check_loop_stamps(const std::vector<double>& loops,
                                              const Trajectory& poses) {
  if (loops.empty() || poses.empty()) return std::nullopt;
  const double as_read = found_part(loops, poses, 1.0);
  if (as_read > kMostly) return std::nullopt;
  const auto [first, last] = std::ranges::minmax(loops);
  const double begin = poses.front().stamp, end = poses.back().stamp;
  InputFinding out{Fault::loop_stamps,
                   fmt::format("{:.0f} % of the loops' stamps ({:.15g} to {:.15g}) are those of "
                               "poses ({:.3f} to {:.3f})",
                               100.0 * as_read,
                               first,
                               last,
                               begin,
                               end),
                   "give the loops of this trajectory, with its stamps",
                   1.0 - as_read,
                   begin - first};
  for (const auto& [factor, unit] : kUnits) {
    // Stamps in seconds are a single one in another unit.
    const bool is_single = factor * (last - first) < kHardly * (end - begin);
    if (is_single || found_part(loops, poses, factor) <= kMostly) continue;
    out.evidence += fmt::format(": they are {}", unit);
    out.fix = "write the stamps of the loops in seconds";
    out.value = 1.0 / factor;
    return out;
  }
  const auto is_index = [&](double stamp) {
    return stamp == std::round(stamp) && stamp >= 0.0 && stamp < begin;
  };
  if (last <= static_cast<double>(poses.size()) && std::ranges::all_of(loops, is_index)) {
    out.evidence += ": they are numbers of poses or frames";
    out.fix = "write the stamps of the poses";
  }
  return out;
}

}  // namespace loopbench::metrics
