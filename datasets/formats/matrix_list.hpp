/// Poses of files that are lists of matrices, one for each row or frame.
#pragma once

#include <string>
#include <vector>

#include "datasets/columns/reading.hpp"
#include "datasets/core/pose.hpp"
#include "datasets/formats/trajectory_file.hpp"

namespace loopbench {

struct ListedMatrix {
  std::string name;  ///< for messages: "row 3", "frame-000003.pose.txt"
  PoseMatrix pose;
  double number = 0.0;  ///< of the row or frame, or a stamp [s]
};

/// Converts matrices to poses as the options state: invalid rows, times or period. The clock of
/// `findings` is that of the numbers. Writes the findings. Throws InputError.
TrajectoryFile poses_of_matrices(const std::string& file,
                                 const std::vector<ListedMatrix>& matrices,
                                 const ReadOptions& options,
                                 ReadFindings findings);

}  // namespace loopbench
