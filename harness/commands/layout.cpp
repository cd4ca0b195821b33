#include "harness/commands/layout.hpp"

#include <algorithm>

#include "datasets/core/error.hpp"

namespace loopbench {
namespace {

using Path = std::filesystem::path;

/// What lies in a folder, by name; nothing when it is not a folder.
std::vector<Path> sorted(const Path& folder) {
  std::vector<Path> out;
  if (!std::filesystem::is_directory(folder)) return out;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) out.push_back(entry.path());
  std::ranges::sort(out);
  return out;
}

bool is_text(const Path& file) {
  const bool is_known = file.extension() == ".txt" || file.extension() == ".csv";
  return is_known && std::filesystem::is_regular_file(file);
}

}  // namespace

std::vector<FilePair> rpg_layout(const Path& folder) {
  const Path reference = folder / "stamped_groundtruth.txt";
  std::vector<FilePair> out;
  for (const Path& file : sorted(folder)) {
    if (is_text(file) && file.filename().string().starts_with("stamped_traj_estimate")) {
      out.push_back({reference.string(), file.string()});
    }
  }
  if (!out.empty() && std::filesystem::exists(reference)) return out;
  throw InputError(folder.string() +
                   ": expected stamped_groundtruth.txt and stamped_traj_estimate*.txt in it");
}

std::vector<FilePair> ov_eval_layout(const Path& truths, const Path& algorithms) {
  std::vector<FilePair> out;
  for (const Path& truth : sorted(truths)) {
    if (!is_text(truth)) continue;
    for (const Path& algorithm : sorted(algorithms)) {
      for (const Path& run : sorted(algorithm / truth.stem())) {
        if (is_text(run)) out.push_back({truth.string(), run.string()});
      }
    }
  }
  if (!out.empty()) return out;
  throw InputError(algorithms.string() +
                   ": no ALGORITHM/DATASET/RUN.txt in it has a DATASET.txt in " + truths.string());
}

}  // namespace loopbench
