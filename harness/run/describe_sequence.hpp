/// Metadata of loaded sequences.
#pragma once

#include "datasets/core/sequence.hpp"
#include "harness/model/cells.hpp"
#include "harness/model/sequence_metadata.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Metadata of the sequence of a cell, with notes about its evaluation; the dataset's `group`
/// overrides the source. Throws InputError.
SequenceMetadata metadata_of(const Sequence& sequence, const Cell& cell, const Sweep& sweep);

}  // namespace loopbench::harness
