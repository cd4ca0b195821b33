/// Times of poses without stamps.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/columns/reading.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// Reads strictly increasing times, one per line, with the unit and order of the options. A file
/// name can be behind the time, as in rgb.txt of TUM.
std::vector<double> read_times(const std::filesystem::path& file, const ReadOptions& options);

/// Replaces the numbers of rows or frames in `poses`, as findings.clock states, by the times of the
/// options, or by multiples of the period. Throws InputError if the times do not fit.
void set_stamps(const std::string& file,
                const ReadOptions& options,
                ReadFindings& findings,
                Trajectory& poses);

}  // namespace loopbench
