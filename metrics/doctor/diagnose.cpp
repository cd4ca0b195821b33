#include "metrics/doctor/diagnose.hpp"

#include <utility>

#include "metrics/doctor/body_checks.hpp"
#include "metrics/doctor/frame_checks.hpp"
#include "metrics/doctor/preconditions.hpp"
#include "metrics/doctor/swapped.hpp"
#include "metrics/doctor/unit_checks.hpp"

namespace loopbench::metrics {
namespace {

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
