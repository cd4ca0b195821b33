/// Folders of estimates as other evaluation tools lay them out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/core/params.hpp"

namespace loopbench {

/// A reference and one of its estimates.
struct FilePair {
  std::string reference;
  std::string estimate;
};

/// rpg_trajectory_evaluation: FOLDER/stamped_groundtruth.txt and FOLDER/stamped_traj_estimate*.txt,
/// in the order of their names. Throws InputError when either is missing, and when there is a
/// start_end_time.yaml: cutting files is left to who knows them.
std::vector<FilePair> rpg_layout(const std::filesystem::path& folder);

/// What FOLDER/eval_cfg.yaml asks of the protocols rpg and rpg-fixed: align_type (sim3, se3, posyaw
/// or none) and align_num_frames (-1: all; 1: the first pose) as `align` and `align_first`. Empty
/// without that file. Throws InputError for anything else in it.
Params rpg_settings(const std::filesystem::path& folder);

/// ov_eval: TRUTHS/DATASET.txt (or .csv) and ALGORITHMS/ALGORITHM/DATASET/RUN.txt, in the order of
/// datasets, algorithms and runs. Throws InputError when nothing belongs together, and for runs of
/// a dataset that has no truth.
std::vector<FilePair> ov_eval_layout(const std::filesystem::path& truths,
                                     const std::filesystem::path& algorithms);

}  // namespace loopbench
