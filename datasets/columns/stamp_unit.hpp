/// Decides the unit of stamps from their size and their intervals.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/columns/reading.hpp"
#include "datasets/columns/text_file.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// The exponent of a unit: 10^exponent s; 0 for `automatic`.
int exponent_of(StampUnit unit);

/// The units that fit the first stamps of `file`, in column `column`, best first, and whether the
/// first one fits best. Stamps end before 2100, and poses are at most 200 s apart. Stamps with
/// decimals are seconds if they can be: no other unit fits. So are whole numbers that are less than
/// 1000 apart, unless another unit gives a time in common with the other file. Of others, those
/// since 1990 fit best, then intervals of 1 ms to 2.5 s. Throws InputError if the stamps are keys
/// of GTSAM.
struct FittingUnits {
  std::vector<StampUnit> units{StampUnit::s};
  bool is_clear = true;
};
FittingUnits fitting_units(const TextFile& file, std::size_t column);

/// The exponent of the stated unit of the options, or else of the fitting ones, which are stored in
/// the findings of `file`.
int stamp_exponent(const TextFile& file, std::size_t column, const ReadOptions& options);

/// Whether a column has numbers of frames instead of stamps, as in KITTI-360: whole numbers below
/// 1e7 without decimals, at most 50 apart.
bool has_frame_numbers(const TextFile& file, std::size_t column);

/// The same for numbers that can have a point: 12.0. Only a times file makes them frames.
bool can_be_frame_numbers(const TextFile& file, std::size_t column);

/// The unit of `own` under which its time has most in common with `other`, if another than the one
/// that was used fits clearly better; `automatic`: none. `offset` is that of the user, to add to
/// the stamps of `own` [s]: if the files overlap with it, no other unit is tried. O(1).
StampUnit better_unit(const Trajectory& own,
                      const ReadFindings& findings,
                      const Trajectory& other,
                      double offset = 0.0);

/// Throws InputError with the units if two fit the stamps of `file` equally well.
void require_clear_unit(const std::string& file, const ReadFindings& findings);

}  // namespace loopbench
