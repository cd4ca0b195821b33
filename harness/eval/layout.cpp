#include "harness/eval/layout.hpp"

#include <algorithm>

#include "datasets/core/error.hpp"
#include "datasets/formats/regular_file.hpp"
#include "harness/config/values.hpp"

namespace loopbench::harness {
namespace {

using Path = std::filesystem::path;

/// Entries of a folder, sorted by name; empty if it is not a folder.
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

/// The name of an alignment of all frames, or of the first one.
std::string align_of(const YamlNode& node, bool is_first_pose) {
  const std::string& word = node.text;
  if (word == "none") return word;
  if (is_first_pose && word == "se3") return "origin";
  if (is_first_pose && word == "posyaw") return "posyaw_origin";
  const bool is_known = word == "sim3" || word == "se3" || word == "posyaw";
  if (is_known && !is_first_pose) return word;
  throw node.error("align_type: expected sim3 | se3 | posyaw | none" +
                   std::string(is_first_pose ? "; for one frame se3 | posyaw | none" : ""));
}

std::int64_t as_frames(const YamlNode& node, const std::string& key) {
  const auto* integer = std::get_if<std::int64_t>(&node.scalar);
  if (integer != nullptr && (*integer == -1 || *integer > 0)) return *integer;
  throw node.error(key + ": expected -1 or a whole number above 0");
}

/// Rejects runs of datasets without a reference in `truths`.
void expect_truths(const Path& truths, const Path& algorithms) {
  for (const Path& algorithm : sorted(algorithms)) {
    for (const Path& dataset : sorted(algorithm)) {
      if (std::ranges::none_of(sorted(dataset), is_text)) continue;
      const std::string name = dataset.filename().string();
      const auto is_reference_of_it = [&](const Path& truth) {
        return is_text(truth) && truth.stem() == dataset.filename();
      };
      if (std::ranges::any_of(sorted(truths), is_reference_of_it)) continue;
      throw InputError(dataset.string() + ": has runs, but there is no reference " + name +
                       ".txt in " + truths.string());
    }
  }
}

}  // namespace

Params rpg_settings(const Path& folder) {
  const Path path = folder / "eval_cfg.yaml";
  if (!std::filesystem::is_regular_file(path)) return {};
  constexpr std::size_t kLargest = std::size_t{1} << 20;  // [bytes]
  const YamlNode node = parse_yaml(read_regular_file(path, kLargest, "file"), path.string());
  require_keys(node, "settings", {"align_type", "align_num_frames"});
  std::int64_t frames = -1;
  read_key(node, "align_num_frames", frames, as_frames);
  Params out;
  if (const YamlNode* type = node.find("align_type")) out["align"] = align_of(*type, frames == 1);
  if (frames > 1) out["align_first"] = frames;
  return out;
}

std::vector<FilePair> rpg_layout(const Path& folder) {
  const Path reference = folder / "stamped_groundtruth.txt";
  std::vector<FilePair> out;
  for (const Path& file : sorted(folder)) {
    if (is_text(file) && file.filename().string().starts_with("stamped_traj_estimate")) {
      out.push_back({reference.string(), file.string()});
    }
  }
  if (const Path cut = folder / "start_end_time.yaml"; std::filesystem::exists(cut)) {
    throw InputError(cut.string() +
                     ": is not supported; cut the files to these times and remove it");
  }
  if (!out.empty() && std::filesystem::exists(reference)) return out;
  throw InputError(
      folder.string() +
      ": expected stamped_groundtruth.txt and stamped_traj_estimate*.txt in the folder");
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
  if (!out.empty()) {
    expect_truths(truths, algorithms);
    return out;
  }
  throw InputError(algorithms.string() +
                   ": found no ALGORITHM/DATASET/RUN.txt with a DATASET.txt in " + truths.string());
}

}  // namespace loopbench::harness
