/// Checks of stamps: unit, frame indices, common time, gaps.
#pragma once

#include <optional>

#include "datasets/core/trajectory.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// The stamps of one file are replaced by factor * stamp + offset.
struct StampRepair {
  InputFinding finding;
  double factor = 1.0;  ///< 0: unknown
  double offset = 0.0;  ///< [s]
  bool is_of_reference = false;
};

/// The stamps of one file fit those of the other only after division by 10^3, 10^6 or 10^9. O(1).
std::optional<StampRepair> check_stamp_unit(const Trajectory& reference,
                                            const Trajectory& estimate);

/// The estimate's stamps are the integers from 0 or 1 on, at which few poses pair or speeds do not
/// agree. Tries usual frame rates and the rate at which both files last equally long. O(1e7).
std::optional<StampRepair> check_frame_indices(const Trajectory& reference,
                                               const Trajectory& estimate);

/// The time ranges do not overlap. O(1).
std::optional<InputFinding> check_overlap(const Trajectory& reference, const Trajectory& estimate);

/// The estimate has no poses in at least a quarter of the reference's path, in gaps above 2 s and
/// ten of its usual intervals. O(n).
std::optional<InputFinding> check_missing(const Trajectory& reference, const Trajectory& estimate);

}  // namespace loopbench::metrics
