/// Inputs with more than one name.
#pragma once

#include <string>
#include <vector>

#include "harness/model/sequence_metadata.hpp"

namespace loopbench::harness {

/// The notes of a sequence, and if the sandbox hides its files from methods, one about files with
/// other names, which the sandbox does not know.
std::vector<std::string> printed_notes(const SequenceMetadata& metadata, bool is_sandboxed);

}  // namespace loopbench::harness
