/// Computes the metadata of a sequence.
#pragma once

#include <vector>

#include "datasets/core/sequence.hpp"
#include "harness/model/cells.hpp"
#include "harness/model/sequence_metadata.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Reads the inputs again to hash them. `group` is the source. Throws InputError.
SequenceMetadata sequence_metadata(const Sequence& sequence, bool with_trace);

/// The same for the sequence of a cell, with notes about its evaluation; the dataset's `group`
/// overrides the source. Throws InputError.
SequenceMetadata metadata_of(const Sequence& sequence, const Cell& cell, const Sweep& sweep);

/// The files with their sizes and hashes. The hash of an optional file that does not exist (an
/// image of a recording) is `missing`, so that a later run detects when it is added. Throws
/// InputError for a file that cannot be read.
std::vector<InputFile> hashed_inputs(const std::vector<InputPath>& files);

}  // namespace loopbench::harness
