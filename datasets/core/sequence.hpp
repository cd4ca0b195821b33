/// One unit of evaluation: a problem, the answer the judge holds, and where each came from.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

/// A file that a dataset read.
struct InputPath {
  std::filesystem::path path;
  std::string option = {};  ///< that names it, for example `estimate`; empty: found by the dataset
};

struct Provenance {
  std::string sensor;                   ///< "RGB-D", "stereo", "simulated"; empty: unknown
  std::string closures;                 ///< where the loop closures were taken from
  bool oracle_closures = false;         ///< the reference measured or selected the closures
  std::string licence;                  ///< of the data; empty: unknown
  std::vector<InputPath> inputs;        ///< every file read
  std::vector<std::string> notes = {};  ///< what a user should know: skipped images, lost tracking
  /// Where the reference's own body was taken to sit, body_from_reference; empty: nobody could say.
  std::optional<Pose> body_from_reference = {};
  std::filesystem::path reference = {};  ///< which of the inputs is the reference; empty: none
  std::string noise = {};  ///< simulated data: stream and seed of all draws; empty: measured data
};

/// What a place recogniser thought of one pair of keyframes, accepted or not.
struct LoopCandidate {
  std::size_t from = 0;  ///< the earlier keyframe
  std::size_t to = 0;    ///< the one that asked
  double score = 0.0;    ///< the higher, the surer; comparable within one sequence
  bool accepted = false;
};

struct Sequence {
  std::string name;
  Problem problem;
  Trajectory reference;  ///< may be empty: then nothing can be judged against it
  Provenance provenance;
  /// Best candidate of every keyframe that found one, sorted by `to`; empty: nothing was detected
  /// here. For judging the detector: no method sees it.
  std::vector<LoopCandidate> loop_candidates = {};
};

}  // namespace loopbench
