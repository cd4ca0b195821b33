/// A calibration as people and configs read it.
#pragma once

#include <string>
#include <vector>

#include "harness/calibrate/ladder.hpp"

namespace loopbench {

struct Calibration {
  std::string config;  ///< as given
  std::vector<Residuals> sequences;
  std::vector<std::string> sources;  ///< of the sequences, see harness/provenance/sequence_identity
  std::vector<std::string> not_trained_on;  ///< the config's other datasets
  std::size_t every = 1;                    ///< keyframe edges taken as one
  std::vector<Rung> rungs;
  std::vector<std::vector<RateInterval>> intervals;  ///< by rung, as options_of()
  /// Root mean square errors at several stretches: where it grows like the stretch and not like
  /// its root, drift is steady.
  struct Stretch {
    std::size_t edges;
    double rms[2];  ///< [m], [rad]
  };
  std::vector<Stretch> stretches;
};

/// YAML: the split, the ladder's held-out likelihoods, then under each method of the ladder the
/// options a config may take over (`calibration: FILE`).
std::string calibration_yaml(const Calibration& calibration);

}  // namespace loopbench
