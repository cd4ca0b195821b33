/// Detection of methods that use, or were trained on, the reference they are evaluated against.
#pragma once

#include <string>

#include "datasets/core/trajectory.hpp"
#include "harness/catalogue/catalogue.hpp"
#include "harness/model/result.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Whether a stage is an oracle (MethodEntry::make_oracle).
bool uses_reference(const MethodChoice& method, const Catalogue& catalogue);

/// Whether all positions are equal to within 1e-9 of the reference's largest distance from its
/// first one. False for fewer than three poses, and for a reference at rest. O(n).
bool has_equal_positions(const Trajectory& estimate, const Trajectory& reference);

/// Message naming the calibration if it was trained on the reference or the noise of this sequence;
/// otherwise empty. Compares sources, see source_of(), and hashes of files, which calibrations of
/// older versions contain; dataset labels if a calibration file has no sources.
std::string trained_on_evaluated(const MethodChoice& method,
                                 const DatasetChoice& dataset,
                                 const SequenceMetadata& metadata);

/// Sets oracle_method of such a cell and adds the reason to its notes. Does nothing for a cell
/// without sequence metadata.
void flag_trained_on_evaluated(CellResult& result, const Sweep& sweep);

}  // namespace loopbench::harness
