#include "harness/sweep/run/estimate_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>

#include "datasets/core/fields.hpp"
#include "datasets/derive/planar.hpp"
#include "datasets/files/replace_file.hpp"
#include "datasets/formats/formats.hpp"
#include "datasets/formats/trajectory_file.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/run/summarise_sequence.hpp"

namespace loopbench::harness {
namespace {

namespace fs = std::filesystem;

struct EstimateFolder {
  fs::path path;  ///< empty: none
  pid_t sweep = 0;
};

EstimateFolder& estimate_folder() {
  static EstimateFolder folder;
  return folder;
}

fs::path estimate_file(const fs::path& folder, const std::string& key, metrics::Times times) {
  return folder / (key + "-" + to_text(times) + ".txt");
}

fs::path reference_file(const fs::path& folder, const std::string& content) {
  return folder / ("reference-" + content + ".txt");
}

/// What the process of a cell writes.
fs::path unnamed_file(const Cell& cell, const std::string& what) {
  return estimate_folder().path /
         fmt::format("cell-{}-{}-{}.txt", cell.index, estimate_folder().sweep, what);
}

/// "cell-INDEX-SWEEP-TIMES.txt", or without the sweep as 1.0 wrote it.
bool is_unnamed(const std::string& name) {
  static const std::regex kName("cell-[0-9]+(-[0-9]+)?-(keyframes|dense|reference)[.]txt");
  return std::regex_match(name, kName);
}

std::string first_line(const std::string& kind, const std::string& key) {
  return "# " + kind + ": " + key + "\n";
}

/// Content of a file without its first line; empty unless that is `first`.
std::string content_after(const fs::path& file, const std::string& first) {
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!text.starts_with(first)) return "";
  return text.erase(0, first.size());
}

/// Moves a file that a cell wrote to its final name, below a line with its key.
void move_below(const std::string& first, const fs::path& from, const fs::path& to) {
  std::error_code ignored;
  if (!fs::exists(from, ignored)) return;
  {
    std::ifstream in(from, std::ios::binary);
    write_result(to, first + std::string{std::istreambuf_iterator<char>(in), {}});
  }
  fs::remove(from, ignored);
}

void save_reference(const Cell& cell, const Sequence& sequence, const Trajectory& reference) {
  const std::string content = content_of(sequence);
  if (reference.empty() || !saved_reference(estimate_folder().path, content).empty()) return;
  const fs::path part = unnamed_file(cell, "reference");
  {
    const WithoutSync until_it_is_kept;
    write_trajectory(part, {.poses = reference}, Format::tum);
  }
  move_below(first_line("content", content), part, reference_file(estimate_folder().path, content));
}

}  // namespace

void set_estimate_folder(const fs::path& folder) {
  estimate_folder() = {folder, getpid()};
  if (folder.empty()) return;
  fs::create_directories(folder);
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (is_unnamed(entry.path().filename().string())) fs::remove(entry.path(), ignored);
  }
}

void save_estimate(const Cell& cell,
                   const Sweep& sweep,
                   const Sequence& sequence,
                   const Curve& curve) {
  if (estimate_folder().path.empty()) return;
  const Rotation body_from_file = sequence.provenance.file_body_from_body.rotation.conjugate();
  const auto of_file = [&](Trajectory poses) {
    change_body(poses, body_from_file);
    return poses;
  };
  save_reference(cell, sequence, of_file(sequence.reference));
  const WithoutSync until_it_is_kept;
  write_tum(unnamed_file(cell, to_text(metrics::Times::keyframes)),
            of_file(curve.sample(stamps(sequence.problem.keyframes))));
  if (std::ranges::count(sweep.times, metrics::Times::dense) == 0) return;
  std::vector<double> times;
  for (const StampedPose& pose : sequence.reference) {
    const double time = pose.stamp - sweep.protocols.front().rules.offset;
    if (time >= curve.start() && time <= curve.end()) times.push_back(time);
  }
  if (!times.empty()) {
    write_tum(unnamed_file(cell, to_text(metrics::Times::dense)), of_file(curve.sample(times)));
  }
}

void forget_estimate(const Cell& cell) {
  if (estimate_folder().path.empty()) return;
  std::error_code absent;
  for (const metrics::Times times : kAllTimes)
    fs::remove(unnamed_file(cell, to_text(times)), absent);
}

void keep_estimate(const Cell& cell, const std::string& key) {
  if (estimate_folder().path.empty()) return;
  for (const metrics::Times times : kAllTimes) {
    move_below(first_line("cell", key),
               unnamed_file(cell, to_text(times)),
               estimate_file(estimate_folder().path, key, times));
  }
}

std::string saved_estimate(const fs::path& folder, const std::string& key, metrics::Times times) {
  return content_after(estimate_file(folder, key, times), first_line("cell", key));
}

std::string saved_reference(const fs::path& folder, const std::string& content) {
  return content_after(reference_file(folder, content), first_line("content", content));
}

void copy_estimates(const fs::path& from,
                    const fs::path& to,
                    const std::string& key,
                    const std::string& content) {
  for (const metrics::Times times : kAllTimes) {
    const std::string text = saved_estimate(from, key, times);
    if (text.empty() || !saved_estimate(to, key, times).empty()) continue;
    write_result(estimate_file(to, key, times), first_line("cell", key) + text);
  }
  const std::string reference = saved_reference(from, content);
  if (reference.empty() || !saved_reference(to, content).empty()) return;
  write_result(reference_file(to, content), first_line("content", content) + reference);
}

}  // namespace loopbench::harness
