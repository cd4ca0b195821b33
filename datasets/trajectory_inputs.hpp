/// Reading of the files of the dataset `trajectory`.
#pragma once

#include "datasets/trajectory_dataset.hpp"

namespace loopbench {

/// Reads all files that the options name. Stamps are those of the estimate's clock, the reference
/// is in the body of the estimate. Adds the files and the notes of the readers to `provenance`.
/// Throws OptionError, InputError.
TrajectoryInputs read_inputs(const TrajectoryOptions& options,
                             const DataRoot& root,
                             Provenance& provenance);

}  // namespace loopbench
