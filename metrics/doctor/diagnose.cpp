#include "metrics/doctor/diagnose.hpp"

#include "metrics/doctor/frame_checks.hpp"
#include "metrics/doctor/swapped.hpp"
#include "metrics/doctor/time_offset.hpp"
#include "metrics/doctor/unit_checks.hpp"

namespace loopbench::metrics {

std::vector<InputFinding> diagnose(const Trajectory& reference,
                                   const Trajectory& estimate,
                                   const std::string& reference_name,
                                   const std::string& estimate_name,
                                   bool has_stamps) {
  std::vector<InputFinding> out;
  if (auto found = check_swapped(reference, estimate, reference_name, estimate_name)) {
    out.push_back(*found);
  }
  const auto add = [&](const std::vector<InputFinding>& more) {
    out.insert(out.end(), more.begin(), more.end());
  };
  std::vector<InputFinding> frames = check_frames(reference, estimate);
  Trajectory shifted;
  if (frames.empty() && has_stamps) {
    if (auto found = check_time_offset(reference, estimate)) {
      out.push_back(*found);
      shifted = estimate;
      for (StampedPose& pose : shifted) pose.stamp += found->value;
      frames = check_frames(reference, shifted);
    }
  }
  add(frames);
  add(check_units(reference, shifted.empty() ? estimate : shifted));
  return out;
}

}  // namespace loopbench::metrics
