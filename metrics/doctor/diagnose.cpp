#include "metrics/doctor/diagnose.hpp"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "datasets/core/trajectory.hpp"
#include "metrics/doctor/body_checks.hpp"
#include "metrics/doctor/finding.hpp"
#include "metrics/doctor/frame_checks.hpp"
#include "metrics/doctor/position_checks.hpp"
#include "metrics/doctor/preconditions.hpp"
#include "metrics/doctor/unit_checks.hpp"
#include "metrics/trajectory/position_only.hpp"

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

/// A finding if the names say so (only the estimate's contains "groundtruth", "truth", "gt" or
/// "vicon" as a word), or if the estimate has at least twice the rate of the reference and covers
/// it in time, and the names do not contradict. O(1).
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
  // Control points and fixes of GNSS are sparse.
  const bool is_denser = rates >= kRates && covers && !is_position_only(reference);
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

Trajectory delayed(Trajectory poses, double offset) {
  for (StampedPose& pose : poses) pose.stamp += offset;
  return poses;
}

void add(std::vector<InputFinding>& to, std::vector<InputFinding> more) {
  to.insert(to.end(), std::move_iterator(more.begin()), std::move_iterator(more.end()));
}

void add(std::vector<InputFinding>& to, std::optional<InputFinding> more) {
  if (more) to.push_back(std::move(*more));
}

}  // namespace

Diagnosis diagnosis(const Trajectory& reference,
                    const Trajectory& estimate,
                    const std::string& reference_name,
                    const std::string& estimate_name,
                    bool has_stamps) {
  if (lacks_rotations(reference) || lacks_rotations(estimate)) {
    return diagnosis_of_positions(reference, estimate, reference_name, estimate_name, has_stamps);
  }
  Diagnosis out;
  add(out.findings, check_swapped(reference, estimate, reference_name, estimate_name));
  if (auto found = has_stamps ? check_stamp_unit(reference, estimate) : std::nullopt) {
    add(out.findings, std::move(found));
    out.unchecked.emplace_back("all other checks: the stamps have to be corrected first");
    out.has_checked = true;
    return out;
  }
  Trajectory shifted;
  if (!has_stamps) {
    out.unchecked.emplace_back("time offset: a file has no stamps");
  } else if (const auto offset = estimate_time_offset(reference, estimate)) {
    out.has_checked = true;
    if (auto found = offset_finding(*offset, estimate)) {
      add(out.findings, std::move(found));
      out.offset = offset;
      shifted = delayed(estimate, offset->offset);
    }
  } else {
    out.unchecked.emplace_back(
        "time offset: fewer than 20 poses, too little motion, or speeds that differ at all "
        "offsets");
  }
  if (has_stamps && shifted.empty()) add(out.findings, check_overlap(reference, estimate));
  const Trajectory& compared = shifted.empty() ? estimate : shifted;
  add(out.findings, check_constant_rotation(reference, estimate));
  std::vector<InputFinding> conventions = check_frames(reference, compared);
  add(conventions, check_units(reference, compared));
  add_lever_arm(conventions, reference, compared);
  const bool is_scaled = conventions.size() == 1 && conventions[0].fault == Fault::scale;
  if (conventions.empty() || is_scaled) add(conventions, find_body_rotation(reference, compared));
  add(out.findings, std::move(conventions));
  const Unchecked parts = unchecked_parts(reference, compared);
  out.unchecked.insert(out.unchecked.end(), parts.reasons.begin(), parts.reasons.end());
  out.has_checked = out.has_checked || parts.checks_units;
  return out;
}

std::vector<InputFinding> diagnose(const Trajectory& reference,
                                   const Trajectory& estimate,
                                   const std::string& reference_name,
                                   const std::string& estimate_name,
                                   bool has_stamps) {
  return diagnosis(reference, estimate, reference_name, estimate_name, has_stamps).findings;
}

}  // namespace loopbench::metrics
