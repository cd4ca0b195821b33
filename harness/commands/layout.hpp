/// Folders of estimates as other evaluation tools lay them out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace loopbench {

/// A reference and one of its estimates.
struct FilePair {
  std::string reference;
  std::string estimate;
};

/// rpg_trajectory_evaluation: FOLDER/stamped_groundtruth.txt and FOLDER/stamped_traj_estimate*.txt,
/// in the order of their names. Throws InputError when either is missing.
std::vector<FilePair> rpg_layout(const std::filesystem::path& folder);

/// ov_eval: TRUTHS/DATASET.txt (or .csv) and ALGORITHMS/ALGORITHM/DATASET/RUN.txt, in the order of
/// datasets, algorithms and runs. Folders without a truth are passed over. Throws InputError when
/// nothing belongs together.
std::vector<FilePair> ov_eval_layout(const std::filesystem::path& truths,
                                     const std::filesystem::path& algorithms);

}  // namespace loopbench
