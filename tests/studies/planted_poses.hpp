/// Faults planted in real recordings, for planted_faults.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench {

struct Recording {
  std::string reference_name, estimate_name;
  Trajectory reference, estimate;
  bool has_stamps = true;
};

struct PlantedFault {
  std::string name;
  metrics::Fault fault;
  std::function<void(Recording&)> plant;
};

std::vector<PlantedFault> faults();

/// Every estimate below `data` next to a reference, sorted by path. Rows of KITTI files are scans
/// of both files.
std::vector<Recording> recordings(const std::filesystem::path& data);

bool is_monocular(const Recording& recording);

}  // namespace loopbench
