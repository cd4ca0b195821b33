/// Calibration results as a YAML file.
#pragma once

#include <string>
#include <vector>

#include "harness/calibrate/nested_models.hpp"

namespace loopbench::harness {

struct Calibration {
  std::string config;  ///< as given
  std::vector<CalibrationResiduals> sequences;
  std::vector<std::string> sources;  ///< of the sequences, see harness/provenance/sequence_identity
  std::vector<std::string> not_trained_on;  ///< the config's other datasets
  std::size_t every = 1;                    ///< number of keyframe edges combined into one
  std::vector<NestedModel> models;
  std::vector<std::vector<RateInterval>> intervals;  ///< by model, as options_of()
  /// Root mean square errors for several group lengths: growth proportional to the length, not to
  /// its square root, indicates drift.
  struct GroupErrors {
    std::size_t edges;
    double rms[2];  ///< [m], [rad]
  };
  std::vector<GroupErrors> group_errors;
};

/// YAML: training and test datasets, held-out likelihoods of the nested models, then for each model
/// the options that a config can use (`calibration: FILE`).
std::string calibration_yaml(const Calibration& calibration);

}  // namespace loopbench::harness
