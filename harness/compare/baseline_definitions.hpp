/// Definitions behind the labels of a baseline.
#pragma once

#include "harness/compare/baseline.hpp"

namespace loopbench::harness {

/// Throws InputError if a sequence, protocol, metric or method of the baseline has the same label
/// in `now` but different options, stages, files or content; the message names the difference.
/// Labels that are missing in `now` are reported with their cells and scores, except protocols.
/// Contents of sequences are compared only between equal machines, because the last digits of a
/// simulated sequence can differ otherwise.
void require_same_definitions(const Snapshot& baseline, const Snapshot& now);

/// "contents are not compared ..." if this applies, otherwise empty.
std::string note_on_contents(const Snapshot& baseline, const Snapshot& now);

}  // namespace loopbench::harness
