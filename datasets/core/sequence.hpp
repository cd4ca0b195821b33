/// A benchmark sequence: the problem, its reference trajectory and their provenance.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

/// A file that a dataset read.
struct InputPath {
  std::filesystem::path path;
  std::string option =
      {};  ///< option with the path, for example `estimate`; empty: found by the dataset
};

struct Provenance {
  std::string sensor;             ///< "RGB-D", "stereo", "simulated"; empty: unknown
  std::string closures;           ///< source of the loop closures
  bool oracle_closures = false;   ///< closures were measured in or selected with the reference
  std::string licence;            ///< licence of the data; empty: unknown
  std::vector<InputPath> inputs;  ///< every file read
  std::vector<std::string> notes = {};  ///< remarks for the user: skipped images, tracking losses
  /// Assumed extrinsic offset of the reference's body; empty: unknown.
  std::optional<Pose> body_from_reference = {};
  std::filesystem::path reference = {};  ///< reference file among `inputs`; empty: none
  std::vector<std::size_t> fixed = {};   ///< keyframes that FIX lines hold, ascending
  std::vector<Edge> held = {};           ///< closures that hold them relative to the first
  /// Of the problem's body in that of the files: the normal of a plane of motion became z.
  Pose file_body_from_body = {};
  std::string noise = {};  ///< stream and seed of simulated noise; empty: measured data
};

/// Pair of keyframes scored by the place recognition, accepted or rejected.
struct LoopCandidate {
  std::size_t from = 0;  ///< the earlier keyframe
  std::size_t to = 0;    ///< the later keyframe, which was the query
  double score = 0.0;    ///< higher is better; comparable within one sequence
  bool accepted = false;
};

struct Sequence {
  std::string name;
  Problem problem;
  Trajectory reference;  ///< may be empty: no metric against the reference is available
  Provenance provenance;
  /// Best candidate of each keyframe that has one, sorted by `to`; empty: the dataset has no loop
  /// detector. Used to evaluate the detector; methods do not receive it.
  std::vector<LoopCandidate> loop_candidates = {};
  /// Indices in problem.closures, ascending, of those that are known to be false; all others are
  /// true. Unset: unknown. Used to evaluate methods that reject closures; they do not receive it.
  std::optional<std::vector<std::size_t>> false_closures = {};
};

/// Default name of the sequence of a file: its folder and its name without extension.
inline std::string default_name(const std::filesystem::path& file) {
  const std::string folder = file.parent_path().filename().string();
  return (folder.empty() ? "" : folder + "_") + file.stem().string();
}

}  // namespace loopbench
