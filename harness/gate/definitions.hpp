/// What the labels of a baseline stand for.
#pragma once

#include "harness/gate/baseline.hpp"

namespace loopbench {

/// Throws InputError when a sequence, protocol, metric or method of the baseline has the same label
/// in `now` but other options, stages, files or content, and names what differs. Labels that are
/// missing in `now` are left to the cells and scores that vanished with them, except protocols.
/// Contents of sequences are compared between equal machines only: elsewhere the last digits of a
/// simulated sequence may differ.
void require_same_definitions(const Snapshot& baseline, const Snapshot& now);

/// "contents are not compared ..." where that applies, or empty.
std::string note_on_contents(const Snapshot& baseline, const Snapshot& now);

}  // namespace loopbench
