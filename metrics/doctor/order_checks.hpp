/// Files whose rows are not what they seem: sorted as text, relative poses, degrees.
#pragma once

#include <optional>
#include <vector>

#include "metrics/doctor/finding.hpp"
#include "metrics/doctor/sampling.hpp"

namespace loopbench::metrics {

/// Rows 0, 1, 2, ... of a list whose `count` files were sorted as text: 0, 1, 10, 100, 101, 11.
/// Element i is the number of row i. O(count log count).
std::vector<std::size_t> numbers_sorted_as_text(std::size_t count);

/// The poses if each row is the motion from the row before: products of the rows. O(n).
Trajectory chained(const Trajectory& motions);

/// Latitude and longitude [deg] and height, or longitude first, in metres at the first position;
/// nullopt if the numbers cannot be degrees. Spherical: shapes are right to 0.7 %. O(n).
std::optional<Trajectory> from_degrees(const Trajectory& positions, bool is_longitude_first);

/// What makes files agree that nothing else makes agree: rows sorted as text (of files without
/// stamps and with equal numbers of rows), relative poses, degrees; of either file. The position
/// error has to fall to a quarter, and below a fifth of the spread. O(n).
std::optional<InputFinding> check_rows(const Trajectory& reference,
                                       const Trajectory& estimate,
                                       bool has_stamps);

/// A linear map that is no similarity makes the positions agree: one axis has another unit, as
/// longitudes that were not multiplied by the cosine of the latitude. nullopt unless the error
/// falls to a fifth of that of a similarity, on poses that were not fitted. O(n).
std::optional<InputFinding> check_shear(const Paired& poses);

}  // namespace loopbench::metrics
