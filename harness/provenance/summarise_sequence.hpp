/// What is kept about a sequence, computed from it.
#pragma once

#include <vector>

#include "datasets/core/sequence.hpp"
#include "harness/model/sequence_metadata.hpp"

namespace loopbench::harness {

/// Reads the inputs again to hash them. `group` is the source. Throws InputError.
SequenceMetadata sequence_metadata(const Sequence& sequence, bool with_trace);

/// The files with their sizes and hashes; `missing` for one that is not there and that its sequence
/// did without (an image of a recording), so that a later run notices when it has come. Throws
/// InputError for one that cannot be read.
std::vector<InputFile> hashed_inputs(const std::vector<InputPath>& files);

}  // namespace loopbench::harness
