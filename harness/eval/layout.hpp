/// Folder layouts of other evaluation tools.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/core/params.hpp"

namespace loopbench::harness {

/// A reference and one of its estimates.
struct FilePair {
  std::string reference;
  std::string estimate;
};

/// rpg_trajectory_evaluation: FOLDER/stamped_groundtruth.txt and FOLDER/stamped_traj_estimate*.txt,
/// sorted by name. Throws InputError if either is missing, or if there is a start_end_time.yaml,
/// because cutting files is not supported.
std::vector<FilePair> rpg_layout(const std::filesystem::path& folder);

/// Settings of FOLDER/eval_cfg.yaml for the protocols rpg and rpg-fixed: align_type (sim3, se3,
/// posyaw or none) and align_num_frames (-1: all; 1: the first pose) as `align` and `align_first`.
/// Empty without that file. Throws InputError for any other setting.
Params rpg_settings(const std::filesystem::path& folder);

/// ov_eval: TRUTHS/DATASET.txt (or .csv) and ALGORITHMS/ALGORITHM/DATASET/RUN.txt, sorted by
/// dataset, algorithm and run. Throws InputError if no files match, or if runs have no reference.
std::vector<FilePair> ov_eval_layout(const std::filesystem::path& truths,
                                     const std::filesystem::path& algorithms);

}  // namespace loopbench::harness
