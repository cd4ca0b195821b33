/// Parts of an estimate that are in different frames: new maps after tracking was lost, jumps of
/// the frame, frozen poses, changes of scale.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "metrics/doctor/finding.hpp"
#include "metrics/doctor/sampling.hpp"

namespace loopbench::metrics {

/// Rows begin <= i < end of a trajectory, from 0 on.
struct RowRange {
  std::size_t begin = 0;
  std::size_t end = 0;
  friend bool operator==(const RowRange&, const RowRange&) = default;
};

/// Pairs of rows of the estimate and the reference, and which pairs belong together.
struct PartedPairs {
  Paired pairs;                 ///< without those that belong to no part
  std::vector<RowRange> parts;  ///< of the pairs
};

/// Poses that stay the same to every digit, for at least two seconds and ten intervals, while the
/// other file moves by a twentieth of its spread. They are removed from the pairs. `file`: of which
/// rows are named. O(pairs).
std::optional<InputFinding> remove_frozen(Paired& pairs, const Trajectory& file, bool of_reference);

/// The estimate's pose is that of its origin again, or its motion from one row to the next is
/// larger than the reference's by twenty times the usual difference (of displacements or angles):
/// its parts, if their errors with an alignment each are below `most` of the whole's. Pairs of
/// parts of less than ten are removed, later parts are moved into the frame of the first. O(pairs).
std::optional<InputFinding> join_maps(PartedPairs& parted, const Trajectory& file, double most);

/// The ratio of displacements changes once, by at least 15 %, and is constant before and after it;
/// parts as above. O(pairs).
std::optional<InputFinding> join_scales(PartedPairs& parted, const Trajectory& file);

/// Parts of the estimate that have a frame and a scale of their own, in the order of rows; all rows
/// if there is one. Frozen rows, and those of frames with less than ten pairs, belong to none.
/// O(rows log(rows)).
std::vector<RowRange> map_parts(const Trajectory& reference,
                                const Trajectory& estimate,
                                double offset);

/// Root mean square of position errors after an alignment with scale of each part [m]. O(pairs).
double position_error(const PartedPairs& parted);

}  // namespace loopbench::metrics
