/// Pairs of a reference and an estimate, real and simulated, for planted_faults.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench {

struct Recording {
  std::string reference_name, estimate_name;
  Trajectory reference, estimate;
  bool has_stamps = true;
  bool is_car = false;  ///< moves in a plane, so that vertical axes show little
};

/// Every estimate below `data` next to a reference, sorted by path. Rows of KITTI files are scans
/// of both files.
std::vector<Recording> recordings(const std::filesystem::path& data);

/// Smooth paths of hand-held cameras and cars with drift and noise, drawn by seed.
std::vector<Recording> simulated_recordings(unsigned count);

/// Whether the estimate's scale is arbitrary.
bool is_monocular(const Recording& recording);

}  // namespace loopbench
